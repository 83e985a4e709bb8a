#include "sim_node/behaviour/articulated/tree.h"

#include <Eigen/Cholesky>
#include <stdexcept>
#include <string>

namespace tactus::sim::articulated {

int dofs_of(const LinkDef& link) {
  if (link.is_free) return 6;
  switch (link.joint) {
    case JointKind::kRevolute:
    case JointKind::kPrismatic: return 1;
    case JointKind::kUniversal: return 2;
    case JointKind::kBall: return 3;
    case JointKind::kFixed: break;
  }
  return 0;
}

int coordinates_of(const LinkDef& link) {
  if (link.is_free) return 7;
  return link.joint == JointKind::kBall ? 4 : dofs_of(link);
}

Tree::Tree(const std::vector<LinkDef>& defs) {
  links.reserve(defs.size());
  for (std::size_t i = 0; i < defs.size(); ++i) {
    const LinkDef& d = defs[i];
    const auto reject = [&](const char* why) {
      throw std::invalid_argument("link " + std::to_string(i) + " of an articulated system " + why);
    };
    if (d.parent < -1 || d.parent >= static_cast<int>(i)) reject("has a parent that does not come before it");
    if ((i == 0) != (d.parent < 0)) reject("is a second root; only the first link of a system may be a root");
    if (d.is_free && i > 0) reject("is free but has a parent");
    // Joints with several degrees of freedom have massless links in between. A tree with a massless leaf has no
    // dynamics.
    const Eigen::LLT<Eigen::Matrix3d> positive(d.inertia_kg_m2);
    if (!(d.mass_kg > 0) || positive.info() != Eigen::Success)
      reject("has a mass or inertia that is not positive");
    Link link{d, dof_count(), dofs_of(d), coordinates, {}, {}};
    for (JointAxis& axis : link.def.axes)
      if (axis.axis.norm() > 0) axis.axis.normalize();
    const Eigen::Vector3d anchor = d.is_free ? d.centre_m : d.anchor_m;
    link.def.anchor_m = anchor;
    link.from_parent_m =
        d.parent < 0 ? anchor : Eigen::Vector3d(anchor - links[static_cast<std::size_t>(d.parent)].def.centre_m);
    link.to_centre_m = d.centre_m - anchor;
    const bool ball = !d.is_free && d.joint == JointKind::kBall;
    for (int k = 0; k < link.dofs; ++k) {
      Dof dof;
      dof.link = static_cast<int>(i);
      if (ball) {
        dof.damping = d.axes[0].damping;
        dof.friction = d.axes[0].friction;
      } else if (!d.is_free) {
        const JointAxis& a = d.axes[k];
        dof = {static_cast<int>(i), coordinates + k, a.damping, a.stiffness,      a.reference,
               a.friction,          a.lower,         a.upper,   a.motor_velocity, a.motor_effort};
      }
      dofs.push_back(dof);
    }
    coordinates += coordinates_of(d);
    links.push_back(link);
  }
}

}  // namespace tactus::sim::articulated
