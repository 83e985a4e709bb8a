// Impact positions in the events: in the body frames, for every contact law and its internal frames.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <tactus/contact_event_t.hpp>

#include "sim_node/world/simulation.h"
#include "sim_node/behaviour/solver.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

constexpr double kRadius_m = 0.02, kLength_m = 0.2, kMass_kg = 0.3;
const Eigen::Isometry3d kLying(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()));

// A capsule in the air along x, 10 cm above the floor, with its centre of mass somewhere on its axis.
int add_capsule(WorldDef& w, double centre_of_mass_m) {
  const double across = kMass_kg * kLength_m * kLength_m / 12;
  const int body = add_body(w, "capsule", kMass_kg, Vector3d(across, across, across / 50).asDiagonal(),
                            at(0.05, 0.02, kRadius_m + 0.1) * kLying);
  w.bodies.back().centre_of_mass_m = {0, 0, centre_of_mass_m};
  add_shape(w, body, ShapeKind::kCapsule, {kRadius_m, 0, kLength_m});
  return body;
}

// A test scene: the body that strikes, and its true curvature there.
struct Blow {
  WorldDef world = empty_world();
  int body = -1;
  double curvature_1_m = 0;
};

// It stands upright and falls onto its head. The centre of mass is in the middle of the head, which is therefore not an end of
// the body as seen from it.
Blow falling_head_first() {
  Blow b;
  add_floor(b.world);
  b.body = add_capsule(b.world, -kLength_m / 2);
  b.world.bodies.back().pose = at(0.1, 0.2, kLength_m / 2 + kRadius_m + 0.05);
  b.curvature_1_m = 1 / kRadius_m;
  return b;
}

// It hangs on one end, is released horizontally, and strikes with the other end.
Blow swinging_on_a_hinge() {
  Blow b;
  add_floor(b.world);
  b.body = add_capsule(b.world, 0.03);
  add_joint(b.world, JointKind::kRevolute, -1, b.body, b.world.bodies.back().pose * Vector3d(0, 0, -kLength_m / 2),
            {0, 1, 0});
  b.curvature_1_m = 1 / kRadius_m;
  return b;
}

double from_surface_m(const Vector3d& in_body) {
  const Vector3d on_axis(0, 0, std::clamp(in_body.z(), -kLength_m / 2, kLength_m / 2));
  return (in_body - on_axis).norm() - kRadius_m;
}

}  // namespace

TEST_CASE("Impact positions lie on the shapes, also for links and an offset centre of mass") {
  const Blow blow = GENERATE(falling_head_first(), swinging_on_a_hinge());
  Settings s;
  s.solver = GENERATE("impulse", "penalty");
  s.penalty_stiffness_N_m = 100;  // so soft that the impact is a single one
  Solver solver(blow.world, s);
  int impacts = 0;
  for (int i = 0; i < 600; ++i) {
    solver.step();
    for (const Manifold& m : solver.solved()) {
      if (m.impact.count == 0) continue;
      ++impacts;
      const bool first = m.body_a == blow.body;
      CHECK(from_surface_m(first ? m.impact.a_body_m : m.impact.b_body_m) == Approx(0).margin(1e-9));
      CHECK((first ? m.impact.b_body_m : m.impact.a_body_m).z() == Approx(0).margin(1e-9));
    }
  }
  CHECK(impacts > 0);
}

TEST_CASE("An impact is reported in the frame of the displaced and rotated body") {
  WorldDef w = empty_world();
  const Eigen::Isometry3d turned = at(0.3, -0.2, 0.5) * Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized());
  const int wall = add_body(w, "wall", 0, Eigen::Matrix3d::Identity(), turned);
  add_shape(w, wall, ShapeKind::kBox, {0.4, 0.3, 0.1});
  const int ball = add_ball(w, 0.1, 0.02, turned * Vector3d(0.05, 0.03, 0.2));
  w.bodies[static_cast<std::size_t>(ball)].velocity_m_s = turned.linear() * Vector3d(0, 0, -1);
  w.gravity_m_s2.setZero();
  Solver solver(w, Settings{});
  int impacts = 0;
  for (int i = 0; i < 300; ++i) {
    solver.step();
    for (const Manifold& m : solver.solved()) {
      if (m.impact.count == 0) continue;
      ++impacts;
      CHECK((m.impact.a_body_m - Vector3d(0.05, 0.03, 0.05)).norm() < 1e-6);
      CHECK((m.impact.b_body_m + turned.linear() * Vector3d(0, 0, 0.02)).norm() < 1e-6);
    }
  }
  CHECK(impacts == 1);
}

TEST_CASE("An impact is reported with the curvature at its position") {
  const Blow blow = GENERATE(falling_head_first(), swinging_on_a_hinge());
  Settings s;
  s.groups = GENERATE("single", "dual");
  s.visual_thread = "none";
  Simulation simulation(blow.world, s);
  simulation.start(1);
  int hits = 0;
  for (int i = 0; i < 600 && hits == 0; ++i) {
    simulation.step({});
    for (const contact_event_t& e : simulation.events()) {
      if (e.kind != contact_event_t::HIT) continue;
      ++hits;
      CHECK(e.curvature_1_m == Approx(blow.curvature_1_m));
    }
  }
  CHECK(hits > 0);
}

TEST_CASE("A step that is divided reports its fastest impact") {
  // A rod falls onto one end, turns about it and strikes with the other one 6.7 ms later, within a step of 17 ms. Impulse of
  // the first end without restitution: a quarter of the momentum, after which the other end moves at 1.5 times the speed.
  WorldDef w = empty_world(0);
  add_floor(w, 0);
  const double tilt = 0.05, speed = 1, r = 0.01, length = 0.2, mass = 0.3, across = mass * length * length / 12;
  const int rod = add_body(w, "rod", mass, Vector3d(across, across, mass * r * r / 2).asDiagonal(),
                           at(0, 0, r + 0.003 + length / 2 * std::sin(tilt)) * Eigen::AngleAxisd(M_PI / 2 + tilt, Vector3d::UnitY()));
  add_shape(w, rod, ShapeKind::kCapsule, {r, 0, length}, 0);
  w.bodies.back().velocity_m_s = {0, 0, -speed};
  Settings s;
  s.step_s = 1.0 / 60;
  Solver solver(w, s);
  double fastest = 0;
  int parts = 0, impacts = 0;
  for (int i = 0; i < 3; ++i) {
    solver.step();
    parts = std::max(parts, solver.report()->substeps);
    for (const Manifold& m : solver.solved()) {
      if (m.impact.count == 0) continue;
      impacts = std::max(impacts, m.impact.count);
      fastest = std::max(fastest, m.impact.speed_m_s);
    }
  }
  CHECK(parts > 1);
  CHECK(impacts > 1);
  CHECK(fastest == Approx(1.5 * speed).epsilon(0.02));
}
