#include "sim_node/behaviour/impulse/world.h"
#include "sim_node/state/archive_motion.h"

namespace tactus::sim::impulse {
namespace {

// Points that one step remembers: as many as a step of ODE may solve.
constexpr std::size_t kMostKept = 16384;

void archive(StateArchive& a, FreeBody& b) {
  a(b.centre_m), a(b.orientation), a(b.velocity_m_s), a(b.step_s), a(b.spin_rad_s), a(b.force_N), a(b.moment_N_m);
  a.require(std::abs(b.orientation.squaredNorm() - 1) < 1e-6, "the state holds an orientation that is none");
}

void archive(StateArchive& a, articulated::ArticulatedSystem& system) {
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
  a.list(kept_, kMostKept, [&](Kept& k) {
    a.index(k.shape_a, shapes), a.index(k.shape_b, shapes);
    a(k.place_m), a(k.force_N);
  });
}

void World::archive(StateArchive& a) {
  for (FreeBody& b : free_) impulse::archive(a, b);
  for (System& s : systems_) {
    impulse::archive(a, s.system);
    for (auto* list : {&s.memory.friction, &s.memory.motor, &s.memory.limit, &s.memory.spring})
      a.fixed(*list, [&](double& x) { a(x); });
  }
  warm_.archive(a, surfaces_.size());
  a.fixed(motions_, [&](BodyMotion& m) { sim::archive(a, m); });
}

}  // namespace tactus::sim::impulse
