// Bodies that slide or roll over flush shapes, or fly closely past an edge, meet no edge.
#include <catch2/catch.hpp>

#include "sim_node/behaviour/solver.h"
#include "tests/sim_node/support/small_worlds.h"
#include "tests/sim_node/support/solver_steps.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

// Boards of 0.2 m along x whose upper sides are at z = 0: static ones, or loose ones at rest on a floor and beside each other.
void add_boards(WorldDef& w, bool loose, double friction) {
  for (int i = -1; i < 12; ++i) {
    const int board = add_box(w, 5, {loose ? 0.1998 : 0.2, 1, 0.1}, at(0.2 * i, 0, -0.05));
    w.bodies[static_cast<std::size_t>(board)].is_static = !loose;
    w.shapes.back().friction = friction;
  }
  if (!loose) return;
  add_floor(w, 1);
  w.shapes.back().pose.translation().z() -= 0.1001;
}

BodyMotion moved(WorldDef& w, int moving, double speed, double seconds) {
  w.bodies[static_cast<std::size_t>(moving)].velocity_m_s = {speed, 0, 0};
  Solver s(w, {});
  for (int i = 0; i < seconds * 1000; ++i) s.step();
  return body(s, moving);
}

}  // namespace

TEST_CASE("A box without friction slides over flush boards at its speed, without rotation") {
  WorldDef w = empty_world();
  add_boards(w, GENERATE(false, true), 0);
  const double speed = GENERATE(0.05, 0.3, 1.0, 2.0), angle = GENERATE(0.0, 0.4);
  const Eigen::Isometry3d pose = at(0, 0, 0.0501) * Eigen::AngleAxisd(angle, Vector3d::UnitZ());
  const int box = add_box(w, 1, {0.1, 0.1, 0.1}, pose);
  w.shapes.back().friction = 0;
  const BodyMotion m = moved(w, box, speed, 1);
  CAPTURE(speed, angle);
  CHECK(m.centre_m.x() == Approx(speed).margin(1e-4));
  CHECK(m.velocity_m_s.x() == Approx(speed).epsilon(1e-4));
  CHECK(m.spin_rad_s.norm() < 1e-3);
}

TEST_CASE("Friction stops a box on flush boards where it would on one") {
  WorldDef w = empty_world();
  add_boards(w, false, 0.2);
  const int box = add_box(w, 1, {0.1, 0.1, 0.05}, at(0, 0, 0.0251));
  w.shapes.back().friction = 0.2;
  CHECK(moved(w, box, 2, 2).centre_m.x() == Approx(4 / (2 * 0.2 * kG)).epsilon(2e-3));  // v^2 / (2 mu g)
}

TEST_CASE("A ball rolls over flush boards at its speed") {
  WorldDef w = empty_world();
  add_boards(w, false, 0.5);
  const double speed = GENERATE(0.2, 1.0, 2.0);
  const int ball = add_ball(w, 1, 0.03, {0, 0, 0.0301});
  w.bodies.back().spin_rad_s = {0, speed / 0.03, 0};
  const BodyMotion m = moved(w, ball, speed, 1);
  CAPTURE(speed);
  CHECK(m.velocity_m_s.x() == Approx(speed).epsilon(1e-3));
  CHECK(m.centre_m.x() == Approx(speed).epsilon(1e-3));
}

TEST_CASE("A box that flies past an edge keeps its velocity, and one that is too low strikes it") {
  WorldDef w = empty_world(0);
  const int wall = add_box(w, 1, {0.2, 0.2, 0.2}, at(0.5, 0, 0));
  w.bodies[static_cast<std::size_t>(wall)].is_static = true;
  const double clear = GENERATE(1e-5, 1e-4, 3e-4, -0.002);
  const int box = add_box(w, 1, {0.1, 0.1, 0.1}, at(0, 0, 0.15 + clear));
  const BodyMotion m = moved(w, box, 2, 0.5);
  CAPTURE(clear);
  if (clear > 0) {
    CHECK(m.velocity_m_s.x() == Approx(2).epsilon(1e-6));
    CHECK(m.spin_rad_s.norm() < 1e-3);
  } else {
    CHECK(m.velocity_m_s.x() < 1.9);
  }
}
