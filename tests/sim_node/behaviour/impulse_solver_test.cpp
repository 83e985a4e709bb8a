#include <catch2/catch.hpp>
#include <cmath>

#include "sim_node/world/simulation.h"
#include "sim_node/behaviour/solver.h"
#include "sim_node/scene/load_sdf.h"
#include "sync/bus/identity.h"
#include "tests/sim_node/support/small_worlds.h"
#include "tests/sim_node/support/solver_steps.h"
#include "tests/source_dir.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

Settings impulse_solver() {
  Settings s;
  s.solver = "impulse";
  return s;
}

}  // namespace

TEST_CASE("In the impulse solver joint angles and limits follow SDF, from either side of the joint") {
  // The world is connected to the child or to the parent. In the second case the tree runs against the joint.
  const bool reversed = GENERATE(false, true);
  const JointKind kind = GENERATE(JointKind::kRevolute, JointKind::kUniversal);
  WorldDef w = empty_world(0);
  const Eigen::Isometry3d pose(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));
  const int moved = add_body(w, "moved", 1, Eigen::Matrix3d::Identity() * 0.01, pose);
  JointDef& joint = reversed ? add_joint(w, kind, moved, -1, {0, 0, 0}, {1, 0, 0})
                             : add_joint(w, kind, -1, moved, {0, 0, 0}, {1, 0, 0});
  joint.axes[0].lower = -0.2;
  joint.axes[0].upper = 0.6;
  joint.axes[1].lower = -0.3;
  joint.axes[1].upper = 0.5;
  const auto turned = [&](const Vector3d& torque) {
    Solver s(w, impulse_solver());
    const Vector3d lever = torque.unitOrthogonal(), f = torque.normalized().cross(lever) * torque.norm() / 2;
    for (int i = 0; i < 2000; ++i) {
      s.add_force(moved, f, body(s, moved).centre_m + lever);
      s.add_force(moved, -f, body(s, moved).centre_m - lever);
      s.step();
    }
    return Eigen::Quaterniond(body(s, moved).orientation * Eigen::Quaterniond(pose.linear()).conjugate());
  };
  const double sign = reversed ? -1 : 1;
  CHECK(sign * angle_about(turned({sign * 0.02, 0, 0}), {1, 0, 0}) == Approx(0.6).margin(1e-4));
  CHECK(sign * angle_about(turned({-sign * 0.02, 0, 0}), {1, 0, 0}) == Approx(-0.2).margin(1e-4));
  if (kind == JointKind::kUniversal) {
    CHECK(sign * angle_about(turned({0, sign * 0.02, 0}), {0, 1, 0}) == Approx(0.5).margin(1e-4));
    CHECK(sign * angle_about(turned({0, -sign * 0.02, 0}), {0, 1, 0}) == Approx(-0.3).margin(1e-4));
  }
}

TEST_CASE("In the impulse solver a chain keeps its energy better than in ODE and stays connected") {
  WorldDef w = chain_world(11);
  // Horizontal: rotated about the hook.
  const Eigen::Isometry3d lie = at(0, 0, 2) * Eigen::AngleAxisd(-M_PI / 2, Vector3d::UnitY()) * at(0, 0, -2);
  for (BodyDef& b : w.bodies) b.pose = lie * b.pose;
  for (JointDef& j : w.joints) {
    j.anchor_m = lie * j.anchor_m;
    for (JointAxis& a : j.axes) a.axis = lie.linear() * a.axis;
  }
  w.shapes.clear();
  Solver s(w, impulse_solver());
  const auto energy = [&] {
    double sum = 0;
    for (const BodyMotion& b : s.bodies())
      sum += (b.velocity_m_s.squaredNorm() / 2 + kG * b.position_m.z()) / b.inverse_mass_1_kg +
             b.spin_rad_s.dot(b.inverse_inertia.inverse() * b.spin_rad_s) / 2;
    return sum;
  };
  const double start = energy();
  double last = 0;
  for (int i = 0; i < 2000; ++i) {
    s.step();
    last = energy();
  }
  CHECK(largest_joint_gap_m(w, s.bodies()) < 1e-9);
  // Published velocities are means over a step: at the rates of the whip they contain slightly less energy.
  CHECK(std::abs(last - start) < 0.03 * 2.968);
}

TEST_CASE("In the impulse solver a box rests, a ball bounces and a stack stands") {
  WorldDef w = empty_world();
  add_floor(w, 0.5, 1);
  const int ball = add_ball(w, 0.2, 0.03, {1, 0, 0.53}, 0.5, 0.8);
  for (int i = 0; i < 5; ++i) add_box(w, 0.5, {0.1, 0.1, 0.1}, at(0, 0, 0.05 + 0.1 * i));
  Solver s(w, impulse_solver());
  double top = 0;
  for (int i = 0; i < 3000; ++i) {
    s.step();
    if (body(s, ball).velocity_m_s.z() > 0 && i < 600) top = std::max(top, body(s, ball).position_m.z() - 0.03);
  }
  // The overlap at which ODE finds the contact determines the time of the impact.
  CHECK(top == Approx(0.64 * 0.5).epsilon(2e-3));
  for (int i = 1; i <= 5; ++i) {
    const Vector3d p = body(s, ball + i).position_m;
    CHECK(p.head<2>().norm() < 1e-3);
    CHECK(p.z() == Approx(0.1 * i - 0.05).margin(2e-4 * i));
  }
  double sum = 0;
  for (int i = 0; i < 100; ++i) {
    s.step();
    for (const Manifold& m : s.solved())
      for (const ManifoldPoint& p : m.used())
        if (m.body_b == ball + 1 && m.body_a == 0) sum += p.normal_force_N / 100;
  }
  CHECK(sum == Approx(2.5 * kG).epsilon(0.01));
}

TEST_CASE("The impulse solver rejects joints that close a loop by name") {
  WorldDef w = chain_world(3);
  add_joint(w, JointKind::kBall, -1, 2, {0, 0, 1.7}, {1, 0, 0}).name = "bite";
  CHECK_THROWS_WITH(Solver(w, impulse_solver()), Catch::Contains("bite") && Catch::Contains("loop"));
}

TEST_CASE("The impulse solver runs the dark room identically twice, with balls that stay on the table") {
  const auto run = [](std::uint64_t& digest, double& fan, double& lowest) {
    std::vector<std::string> warnings;
    const WorldDef world = load_sdf(tactus::source_dir() + "/sim_node/scenes/dark_room.sdf", warnings);
    Settings settings = impulse_solver();
    Simulation s(world, settings);
    s.start(11);
    for (int i = 0; i < 3000; ++i) s.step({});
    std::vector<double> state;
    lowest = 1;
    fan = 0;
    for (std::size_t i = 0; i < s.bodies().size(); ++i) {
      const BodyMotion& b = s.bodies()[i];
      REQUIRE(b.position_m.allFinite());
      for (int k = 0; k < 3; ++k) state.insert(state.end(), {b.position_m[k], b.velocity_m_s[k]});
      if (world.bodies[i].is_static || world.bodies[i].tool >= 0) continue;
      lowest = std::min(lowest, b.position_m.z());
      if (world.bodies[i].name.find("fan") != std::string::npos) fan = std::max(fan, b.spin_rad_s.norm());
    }
    digest = tactus::sync::fnv1a_64(state.data(), state.size() * sizeof(double));
  };
  std::uint64_t first, second;
  double fan, lowest;
  run(first, fan, lowest);
  run(second, fan, lowest);
  CHECK(first == second);
  CHECK(fan == Approx(3.75).epsilon(0.05));
  CHECK(lowest > -0.5);
}
