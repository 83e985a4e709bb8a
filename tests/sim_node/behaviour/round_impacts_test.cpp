// Impacts of bodies that spin: rotation moves no point of contact of a ball, cylinder or capsule.
#include <catch2/catch.hpp>

#include "sim_node/behaviour/solver.h"
#include "tests/sim_node/support/small_worlds.h"
#include "tests/sim_node/support/solver_steps.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

constexpr double kRadius = 0.05;

// A body above a floor, which falls while it spins, 0.4 s later: after its first impact.
BodyMotion after_a_drop(ShapeKind kind, double friction, double restitution, const Vector3d& velocity, double spin, double height = 0.55) {
  WorldDef w = empty_world();
  add_floor(w, friction, restitution);
  const int ball = add_ball(w, 1, kRadius, {0, 0, height}, friction, restitution);
  if (kind != ShapeKind::kSphere) {
    ShapeDef& s = w.shapes.back();
    s.kind = kind;
    s.size_m = {kRadius, kRadius, 0.1};
    s.pose.linear() = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()).toRotationMatrix();
  }
  w.bodies.back().velocity_m_s = velocity;
  w.bodies.back().spin_rad_s = {0, spin, 0};
  Solver s(w, {});
  for (int i = 0; i < 400; ++i) s.step();
  return body(s, ball);
}

}  // namespace

TEST_CASE("An impact without friction leaves the spin of a round body as it is") {
  const ShapeKind kind = GENERATE(ShapeKind::kSphere, ShapeKind::kCylinder, ShapeKind::kCapsule);
  const double restitution = GENERATE(0.0, 0.7, 1.0);
  // Different heights: impacts at different times of a step.
  const double height = 0.5 + GENERATE(take(4, random(0.0, 0.1)));
  const BodyMotion m = after_a_drop(kind, 0, restitution, {0.3, 0, 0}, 100, height);
  CAPTURE(static_cast<int>(kind), restitution, height);
  CHECK(m.spin_rad_s.y() == Approx(100).epsilon(1e-6));
  CHECK(m.velocity_m_s.x() == Approx(0.3).epsilon(1e-6));
}

TEST_CASE("A spinning ball that grips the floor leaves with 2/7 of the speed of its surface") {
  // Angular momentum about the point of contact: m R v + 0.4 m R^2 w is kept, and the ball rolls after the impact (Garwin 1969,
  // American Journal of Physics 37:88).
  const double speed = GENERATE(0.0, 1.0, -1.0), spin = GENERATE(20.0, -80.0), height = 0.5 + GENERATE(take(3, random(0.0, 0.1)));
  const BodyMotion m = after_a_drop(ShapeKind::kSphere, 1, 0.8, {speed, 0, 0}, spin, height);
  const double right = (speed + 0.4 * kRadius * spin) / 1.4;
  CAPTURE(speed, spin, height);
  CHECK(m.velocity_m_s.x() == Approx(right).margin(2e-4 * (std::abs(speed) + kRadius * std::abs(spin))));
  CHECK(m.spin_rad_s.y() * kRadius == Approx(right).margin(2e-4 * (std::abs(speed) + kRadius * std::abs(spin))));
}

TEST_CASE("Of two equal balls the one in motion stops and keeps its spin, and the other takes its speed") {
  WorldDef w = empty_world(0);
  const int first = add_ball(w, 1, kRadius, {0, 0, 0}, 0, 1), second = add_ball(w, 1, kRadius, {0.3337, 0, 0}, 0, 1);
  w.bodies[static_cast<std::size_t>(first)].velocity_m_s = {2, 0, 0};
  w.bodies[static_cast<std::size_t>(first)].spin_rad_s = {0, 100, 0};
  Solver s(w, {});
  for (int i = 0; i < 300; ++i) s.step();
  CHECK(body(s, first).velocity_m_s.norm() == Approx(0).margin(1e-6));
  CHECK(body(s, first).spin_rad_s.y() == Approx(100).epsilon(1e-6));
  CHECK(body(s, second).velocity_m_s.x() == Approx(2).epsilon(1e-6));
  CHECK(body(s, second).spin_rad_s.norm() == Approx(0).margin(1e-6));
}
