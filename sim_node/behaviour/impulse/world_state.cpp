#include <Eigen/Cholesky>

#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/model/archive_motion.h"

namespace tactus::sim::impulse {
namespace {

// Maximum number of stored points: the number that a step of ODE may solve.
constexpr std::size_t kMaxKept = 16384;

void archive(StateArchive& a, FreeBody& b) {
  a(b.mass_kg), a(b.inertia_kg_m2), a(b.gravity_m_s2);
  const Eigen::LLT<Eigen::Matrix3d> positive(b.inertia_kg_m2);
  a.require(b.mass_kg > 0 && positive.info() == Eigen::Success, "the state holds a mass that is not positive");
  a(b.centre_m), a(b.orientation), a(b.velocity_m_s), a(b.step_s), a(b.spin_rad_s), a(b.force_N), a(b.moment_N_m);
  a.require(std::abs(b.orientation.squaredNorm() - 1) < 1e-6, "the state holds an invalid orientation");
  a.require(!a.reads() || plausible(b.centre_m, b.velocity_m_s, b.spin_rad_s), kImplausible);
}

void archive(StateArchive& a, articulated::ArticulatedSystem& system) {
  for (std::size_t i = 0; i < system.tree().links.size(); ++i) {
    Eigen::Vector3d gravity = system.tree().links[i].def.gravity_m_s2;
    a(gravity);
    if (a.reads()) system.set_gravity(static_cast<int>(i), gravity);
  }
  for (std::size_t j = 0; j < system.tree().dofs.size(); ++j) {
    articulated::Dof dof = system.tree().dofs[j];
    a(dof.friction), a(dof.motor_effort), a(dof.motor_velocity);
    if (!a.reads()) continue;
    system.set_friction(static_cast<int>(j), dof.friction);
    system.set_motor(static_cast<int>(j), dof.motor_effort, dof.motor_velocity);
  }
  articulated::ArticulatedSystem::State state = system.state();
  const auto number = [&](double& x) { a(x); };
  a.fixed(state.positions, number);
  a.fixed(state.rates, number);
  a(state.reach_s);
  a.require(state.reach_s >= 0, "the state holds a number out of range");
  if (a.reads()) system.set_state(state);
}

}  // namespace

void WarmStart::archive(StateArchive& a, std::size_t shapes) {
  a.list(stored_, kMaxKept, [&](StoredPoint& k) {
    a.index(k.shape_a, shapes), a.index(k.shape_b, shapes);
    a(k.position_m), a(k.normal), a(k.force_N), a(k.shell_m);
  });
}

void World::archive(StateArchive& a) {
  for (FreeBody& b : free_) impulse::archive(a, b);
  for (Surface& s : surfaces_) a(s.friction), a(s.restitution);
  for (System& s : systems_) {
    impulse::archive(a, s.system);
    s.has_rows = needs_rows(s.system);
    for (auto* list : {&s.memory.friction, &s.memory.motor, &s.memory.limit, &s.memory.spring})
      a.fixed(*list, [&](double& x) { a(x); });
  }
  warm_.archive(a, surfaces_.size());
  a.fixed(motions_, [&](BodyMotion& m) { sim::archive(a, m); });
}

}  // namespace tactus::sim::impulse
