#include <catch2/catch.hpp>

#include "sim_node/behaviour/impulse/world.h"
#include "tests/sim_node/support/articulated_trees.h"

using namespace tactus::sim;
using namespace tactus::sim::impulse;
using Eigen::Vector3d;

namespace {

FreeBody thrown_body() {
  FreeBody b;
  b.mass_kg = 0.3;
  b.inertia_kg_m2 = Vector3d(1e-4, 2e-4, 3e-4).asDiagonal();
  b.gravity_m_s2 = {0, 0, -9.81};
  b.centre_m = {0, 0, 1};
  b.velocity_m_s = {0.4, 0, 2};
  b.step_s = 0;
  b.spin_rad_s = {3, 1, 2};
  return b;
}

// A pendulum and two flying bodies; three units.
World three() {
  World w;
  w.add_free(thrown_body());
  tactus::sim::test::add_system(w, articulated::ArticulatedSystem(tactus::sim::test::horizontal_chain(1)));
  w.add_free(thrown_body());
  return w;
}

}  // namespace

TEST_CASE("A flying body follows the parabola for any step lengths", "[impulse]") {
  World w;
  w.add_free(thrown_body());
  double t = 0;
  for (const double h : {0.001, 0.004, 0.00425, 0.001, 0.0167, 0.002}) {
    w.step({}, h);
    t += h;
    const Vector3d on = Vector3d(0, 0, 1) + t * Vector3d(0.4, 0, 2) - Vector3d(0, 0, 9.81 / 2 * t * t);
    CHECK((w.motions()[0].centre_m - on).norm() < 1e-12);
  }
}

TEST_CASE("An inactive unit does not move and does not affect the active ones", "[impulse]") {
  World all = three(), some = three();
  const std::vector<int> second{1};
  CHECK(some.unit_of(2) == 1);
  some.set_active(second);
  for (int i = 0; i < 50; ++i) {
    all.step({}, 0.001);
    some.step({}, 0.001);
  }
  CHECK(some.motions()[2].centre_m == all.motions()[2].centre_m);
  CHECK(some.motions()[0].centre_m == thrown_body().centre_m);
  CHECK(std::vector<int>(some.active_bodies().begin(), some.active_bodies().end()) == std::vector<int>{2});
}

TEST_CASE("A unit that moves to another world continues unchanged", "[impulse]") {
  // Alone, in 200 steps of 1 ms; then 100 of them in a world with other steps.
  World whole = three(), first = three(), second = three();
  for (int i = 0; i < 7; ++i) second.step({}, 0.004);
  for (int i = 0; i < 200; ++i) whole.step({}, 0.001);
  for (int i = 0; i < 100; ++i) first.step({}, 0.001);
  UnitState state;
  for (int unit = 0; unit < first.units(); ++unit) {
    first.copy_state(unit, state);
    second.set_state(unit, state);
  }
  for (const std::size_t body : {0u, 1u, 2u})
    CHECK((second.motions()[body].centre_m - first.motions()[body].centre_m).norm() < 1e-15);
  for (int i = 0; i < 100; ++i) second.step({}, 0.001);
  for (const std::size_t body : {0u, 1u, 2u}) {
    CHECK((second.motions()[body].centre_m - whole.motions()[body].centre_m).norm() < 1e-9);
    CHECK(second.motions()[body].orientation.angularDistance(whole.motions()[body].orientation) < 1e-9);
  }
}
