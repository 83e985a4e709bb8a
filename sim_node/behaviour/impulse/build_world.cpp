#include "sim_node/behaviour/impulse/build_world.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "sim_node/model/behaviour_model.h"
#include "sim_node/model/index.h"

namespace tactus::sim::impulse {
namespace {

using articulated::LinkDef;

// kShell_m: surfaces meet at this gap, so that residuals of the sweeps are not overlaps. Design value: equal to
// the allowed overlap, 10 um. kSlack_m: the part that is not corrected, a fifth, above the rounding of detectors.
constexpr double kShell_m = 1e-5, kSlack_m = 2e-6;

// The settings must name a model that is solved by impulses.
ContactLaw contact_law(const Settings& s) {
  ContactLaw law{.sweeps = s.iterations,
                 .bounce_speed_m_s = s.bounce_speed_m_s,
                 .slop_m = kSlack_m,
                 .correction_share = s.contact_erp,
                 .max_correction_speed_m_s = s.correcting_speed_m_s,
                 .shell_m = s.groups == "dual" ? s.contact_tolerance_m : kShell_m};
  if (behaviour_model(s.solver).finite_forces) {
    law.shell_m = kShell_m;
    law.penalty = {.stiffness_N_m = s.penalty_stiffness_N_m,
                   .damping_N_s_m = s.penalty_damping_Ns_m,
                   .thickness_m = s.contact_tolerance_m - kShell_m,  // ends at the gap where surfaces meet
                   .is_explicit = s.solver == "penalty_explicit",
                   .rise_m_s = s.correcting_speed_m_s};
  }
  return law;
}

class Builder {
 public:
  Builder(const WorldDef& def, const Settings& settings)
      : def_(def),
        settings_(settings),
        world_(std::make_unique<World>(contact_law(settings))),
        placed_(def.bodies.size()),
        jointed_(def.bodies.size()),
        used_(def.joints.size()) {}

  std::unique_ptr<World> build() {
    for (const JointDef& j : def_.joints)
      for (const int body : {j.parent, j.child})
        if (moves(body)) jointed_[index(body)] = true;
    for (std::size_t i = 0; i < def_.bodies.size(); ++i) {
      const int body = static_cast<int>(i);
      if (moves(body)) check(def_.bodies[i]);
      if (moves(body) && !jointed_[i])
        world_->add_free(free_body(def_.bodies[i]));
      else
        world_->add_fixed();
    }
    // Builds the systems from their roots: first those connected to the world, then the free ones.
    for (std::size_t j = 0; j < def_.joints.size(); ++j) {
      const JointDef& joint = def_.joints[j];
      if (used_[j] || moves(joint.parent) == moves(joint.child)) continue;
      const bool reversed = moves(joint.parent);
      begin(reversed ? joint.parent : joint.child, &joint, reversed);
      used_[j] = true;
      finish();
    }
    for (std::size_t i = 0; i < def_.bodies.size(); ++i) {
      if (!jointed_[i] || placed_[i]) continue;
      begin(static_cast<int>(i), nullptr, false);
      finish();
    }
    for (const ShapeDef& s : def_.shapes) world_->add_surface({s.friction, s.restitution, round_shape(s)});
    return std::move(world_);
  }

 private:
  RoundShape round_shape(const ShapeDef& s) const {
    RoundShape out;
    if (s.kind == ShapeKind::kSphere || s.kind == ShapeKind::kCapsule) out.kind = RoundShape::Kind::kCapsule;
    if (s.kind == ShapeKind::kCylinder) out.kind = RoundShape::Kind::kCylinder;
    if (s.kind == ShapeKind::kCapsule) out.half_length_m = s.size_m.z() / 2;
    out.centre_m = s.pose.translation() - def_.bodies[index(s.body)].centre_of_mass_m;
    out.axis = s.pose.linear().col(2);
    return out;
  }
  bool moves(int body) const {
    return body >= 0 && !def_.bodies[index(body)].is_static && def_.bodies[index(body)].tool < 0;
  }
  static void check(const BodyDef& b) {
    const Eigen::LLT<Eigen::Matrix3d> positive(b.inertia_kg_m2);
    if (!(b.mass_kg > 0) || !std::isfinite(b.mass_kg) || !b.inertia_kg_m2.allFinite() ||
        positive.info() != Eigen::Success)
      throw std::runtime_error("sim_node: body \"" + b.name +
                               "\" has a mass or inertia that is not positive; correct its <inertial>");
  }
  FreeBody free_body(const BodyDef& b) const {
    FreeBody out;
    out.mass_kg = b.mass_kg;
    out.inertia_kg_m2 = b.inertia_kg_m2;
    if (b.gravity) out.gravity_m_s2 = def_.gravity_m_s2;
    out.linear_damping_1_s = b.linear_damping_1_s;
    out.angular_damping_1_s = b.angular_damping_1_s;
    out.centre_m = b.pose * b.centre_of_mass_m;
    out.orientation = Eigen::Quaterniond(b.pose.linear()).normalized();
    out.step_s = 0;  // the velocity is the current one
    out.velocity_m_s = b.velocity_m_s;
    out.spin_rad_s = b.spin_rad_s;
    return out;
  }
  void begin(int body, const JointDef* joint, bool reversed) {
    links_.clear();
    bodies_.clear();
    add(body, -1, joint, reversed);
  }
  void add(int body, int parent_link, const JointDef* joint, bool reversed) {
    if (placed_[index(body)])
      throw std::runtime_error(
          "sim_node: joint \"" + joint->name +
          "\" closes a loop, which the solver \"" +
          settings_.solver + "\" does not support; remove it or choose quick or step");
    placed_[index(body)] = true;
    const BodyDef& b = def_.bodies[index(body)];
    LinkDef l;
    l.parent = parent_link;
    l.is_free = joint == nullptr;
    l.mass_kg = b.mass_kg;
    l.centre_m = b.pose * b.centre_of_mass_m;
    l.inertia_kg_m2 = b.pose.linear() * b.inertia_kg_m2 * b.pose.linear().transpose();
    if (b.gravity) l.gravity_m_s2 = def_.gravity_m_s2;
    l.linear_damping_1_s = b.linear_damping_1_s;
    l.angular_damping_1_s = b.angular_damping_1_s;
    if (joint) {
      l.joint = joint->kind;
      l.anchor_m = joint->anchor_m;
      for (int k = 0; k < 2; ++k) l.axes[k] = joint->axes[k];
      // From the other side the same angle rotates about the opposite axis, and the child's axis comes first.
      if (reversed) {
        if (joint->kind == JointKind::kUniversal) std::swap(l.axes[0], l.axes[1]);
        for (JointAxis& a : l.axes) a.axis = -a.axis;
      }
    }
    links_.push_back(l);
    bodies_.push_back(body);
  }
  // Follows the joints outwards until no body is left, and creates a system of the bodies found.
  void finish() {
    for (std::size_t link = 0; link < bodies_.size(); ++link)
      for (std::size_t j = 0; j < def_.joints.size(); ++j) {
        const JointDef& joint = def_.joints[j];
        const bool onwards = joint.parent == bodies_[link], back = joint.child == bodies_[link];
        if (used_[j] || !(onwards || back)) continue;
        used_[j] = true;
        const int other = onwards ? joint.child : joint.parent;
        // A second connection to the world is a loop too.
        add(moves(other) ? other : bodies_[link], static_cast<int>(link), &joint, back);
      }
    articulated::ArticulatedSystem system(links_, settings_.step_s);
    set_initial_velocities(system);
    world_->make_system(bodies_, std::move(system));
  }

  // Initial velocities of the bodies. The system at rest receives impulses of the bodies' momenta, which gives the
  // admissible motion with the least kinetic energy difference.
  void set_initial_velocities(articulated::ArticulatedSystem& system) const {
    std::vector<double> rates(system.tree().dofs.size());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const BodyDef& b = def_.bodies[index(bodies_[i])];
      const int link = static_cast<int>(i);
      if (!b.velocity_m_s.isZero(0)) {
        articulated::Dynamics& d = system.dynamics();
        d.impulse_to_rates(link, d.centre_m(link), b.mass_kg * b.velocity_m_s, rates);
        system.add_rates(rates);
      }
      if (b.spin_rad_s.isZero(0)) continue;
      const Eigen::Matrix3d turn = b.pose.linear();
      system.dynamics().angular_impulse_to_rates(link, turn * (b.inertia_kg_m2 * (turn.transpose() * b.spin_rad_s)), rates);
      system.add_rates(rates);
    }
  }

  const WorldDef& def_;
  const Settings& settings_;
  std::unique_ptr<World> world_;
  std::vector<char> placed_, jointed_, used_;
  std::vector<LinkDef> links_;
  std::vector<int> bodies_;
};

}  // namespace

std::unique_ptr<World> build_world(const WorldDef& def, const Settings& settings) {
  return Builder(def, settings).build();
}

}  // namespace tactus::sim::impulse
