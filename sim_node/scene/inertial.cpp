#include "sim_node/scene/inertial.h"

#include <Eigen/Eigenvalues>

#include "sim_node/scene/mass.h"
#include "sim_node/scene/sdf/sdf_eigen.h"

namespace tactus::sim {
namespace {

// SDF's defaults (inertial.sdf), for a body without shapes.
constexpr double kDefaultBodyMass_kg = 1, kDefaultInertia_kg_m2 = 1;

Eigen::Matrix3d read_inertia(const LoadContext& context, const sdf::ElementPtr& inertia) {
  const auto entry = [&](const char* name, double missing) {
    const sdf::ElementPtr given = explicit_child(inertia, name);
    return given ? given->Get<double>() : missing;
  };
  const double xy = entry("ixy", 0), xz = entry("ixz", 0), yz = entry("iyz", 0);
  Eigen::Matrix3d matrix;
  matrix << entry("ixx", 1), xy, xz, xy, entry("iyy", 1), yz, xz, yz, entry("izz", 1);
  if (!matrix.allFinite()) context.reject(*inertia, "is not finite");
  const Eigen::Vector3d moments = matrix.selfadjointView<Eigen::Lower>().eigenvalues();  // ascending
  if (!(moments[0] > 0))
    context.reject(*inertia,
                   "is not positive definite: correct it, or leave it out so that it is computed from the shapes");
  // No mass distribution has such moments; the solver can still step. Tolerance 1 %, because files have few digits.
  if (moments[2] > 1.01 * (moments[0] + moments[1]))
    context.warn(*inertia, "is not physically possible: one principal moment is larger than the sum of the two others");
  return matrix;
}

}  // namespace

void read_inertial(const LoadContext& context, const sdf::ElementPtr& link, std::span<const ShapeDef> shapes,
                   BodyDef& body) {
  if (body.is_static) {
    body.mass_kg = 0;
    return;
  }
  const sdf::ElementPtr inertial = explicit_child(link, "inertial");
  const sdf::ElementPtr mass = explicit_child(inertial, "mass"), inertia = explicit_child(inertial, "inertia");
  bool has_density = false;
  std::vector<MassRemark> remarks;
  MassProperties p = mass_of(context.world, shapes, has_density, &remarks);
  // The shapes have no effect on a body whose mass, inertia and centre of mass are given.
  if (!mass || !inertia)
    for (const MassRemark& r : remarks)
      context.warn(*link, "has mesh \"" + r.shape + "\", which " + r.clause + " for the " +
                              (mass ? "inertia" : inertia ? "mass" : "mass and the inertia") +
                              "; close the mesh, or give <mass> and <inertia>");
  const bool has_volume = p.mass_kg > 0;
  if (!has_volume) p = {kDefaultBodyMass_kg, {0, 0, 0}, kDefaultInertia_kg_m2 * Eigen::Matrix3d::Identity()};
  if (mass) {
    const double given_kg = mass->Get<double>();
    if (!(given_kg > 0 && given_kg < 1e9))
      context.reject(*mass, "= " + mass->GetValue()->GetAsString() +
                                " must be above 0 kg: give the mass, or make the model static");
    p = scaled_to(p, given_kg);
  } else if (!has_density || !has_volume) {
    p = scaled_to(p, kDefaultBodyMass_kg);
  }
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  if (const sdf::ElementPtr pose = explicit_child(inertial, "pose")) {
    frame = to_eigen(pose->Get<ignition::math::Pose3d>());
    if (!frame.matrix().allFinite()) context.reject(*pose, "is not finite");
    p.centre_of_mass_m = frame.translation();
  }
  if (inertia) {
    if (!explicit_child(inertial, "pose")) p.centre_of_mass_m.setZero();  // as SDF defines it
    p.inertia_kg_m2 = frame.linear() * read_inertia(context, inertia) * frame.linear().transpose();
  }
  body.mass_kg = p.mass_kg, body.centre_of_mass_m = p.centre_of_mass_m, body.inertia_kg_m2 = p.inertia_kg_m2;
}

}  // namespace tactus::sim
