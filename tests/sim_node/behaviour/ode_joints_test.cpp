#include <catch2/catch.hpp>

#include "sim_node/behaviour/ode_joints.h"
#include "sim_node/behaviour/solver.h"
#include "tests/sim_node/support/small_worlds.h"
#include "tests/sim_node/support/solver_steps.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

// A body at the origin, joined to the world or to a second, heavy one.
struct Jointed {
  WorldDef world = empty_world(0);
  int parent = -1, child = 0;
  Settings settings;

  explicit Jointed(bool to_body, const std::string& solver) {
    settings.solver = solver;
    child = add_body(world, "child", 1, Eigen::Matrix3d::Identity() * 0.01, at(0, 0, 0));
    if (to_body) parent = add_body(world, "parent", 1e6, Eigen::Matrix3d::Identity() * 1e6, at(0, 0, 1));
  }
  // The child's orientation after a constant torque for this time.
  Eigen::Quaterniond turned(const Vector3d& torque, double seconds) const {
    Solver s(world, settings);
    const Vector3d axis = torque.normalized(), lever = axis.unitOrthogonal();
    for (int i = 0; i < seconds / kStep; ++i) {
      const Vector3d f = axis.cross(lever) * torque.norm() / 2;
      s.add_force(child, f, s.bodies()[0].centre_m + lever);
      s.add_force(child, -f, s.bodies()[0].centre_m - lever);
      s.step();
    }
    return s.bodies()[0].orientation;
  }
};

}  // namespace

TEST_CASE("Joint angles and limits follow SDF: right-handed rotation of the child relative to the parent") {
  const bool to_body = GENERATE(false, true);
  const std::string solver = GENERATE("impulse", "quick");
  Jointed j(to_body, solver);
  SECTION("a revolute joint rotates about its axis within its limits") {
    JointDef& joint = add_joint(j.world, JointKind::kRevolute, j.parent, j.child, {0, 0, 0}, {0, 0, 1});
    joint.axes[0].lower = -0.2;
    joint.axes[0].upper = 0.6;
    CHECK(angle_about(j.turned({0, 0, 0.02}, 2), {0, 0, 1}) == Approx(0.6).margin(0.005));
    CHECK(angle_about(j.turned({0, 0, -0.02}, 2), {0, 0, 1}) == Approx(-0.2).margin(0.005));
    CHECK(angle_about(j.turned({0.02, 0, 0}, 1), {1, 0, 0}) == Approx(0).margin(1e-4));
  }
  SECTION("the first axis of a universal joint is fixed to the parent, the second to the child") {
    JointDef& joint = add_joint(j.world, JointKind::kUniversal, j.parent, j.child, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    joint.axes[0].lower = -0.1;
    joint.axes[0].upper = 0.5;
    joint.axes[1].lower = -0.3;
    joint.axes[1].upper = 0.7;
    CHECK(angle_about(j.turned({0.02, 0, 0}, 2), {1, 0, 0}) == Approx(0.5).margin(0.005));
    CHECK(angle_about(j.turned({-0.02, 0, 0}, 2), {1, 0, 0}) == Approx(-0.1).margin(0.005));
    CHECK(angle_about(j.turned({0, 0.02, 0}, 2), {0, 1, 0}) == Approx(0.7).margin(0.005));
    CHECK(angle_about(j.turned({0, -0.02, 0}, 2), {0, 1, 0}) == Approx(-0.3).margin(0.005));
    CHECK(angle_about(j.turned({0, 0, 0.02}, 1), {0, 0, 1}) == Approx(0).margin(1e-4));
  }
  SECTION("each axis of a universal joint has its own spring") {
    JointDef& joint = add_joint(j.world, JointKind::kUniversal, j.parent, j.child, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    for (int axis = 0; axis < 2; ++axis) joint.axes[axis].damping = 0.1;
    joint.axes[0].stiffness = 1;
    joint.axes[0].reference = 0.2;
    joint.axes[1].stiffness = 1;
    const Eigen::Quaterniond q = j.turned({0, 1e-9, 0}, 5);
    CHECK(angle_about(q, {1, 0, 0}) == Approx(0.2).margin(1e-3));
    CHECK(angle_about(q, {0, 1, 0}) == Approx(0).margin(1e-3));
  }
  SECTION("a ball joint rotates about every axis and a fixed joint about none") {
    JointDef& joint = add_joint(j.world, JointKind::kBall, j.parent, j.child, {0, 0, 0}, {1, 0, 0});
    // alpha t^2 / 2; ODE's sum of the steps is alpha t (t + h) / 2.
    const double free = 0.5 * 2 * 0.5 * (solver == "quick" ? 0.501 : 0.5);
    for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)})
      CHECK(angle_about(j.turned(0.02 * axis, 0.5), axis) == Approx(free).epsilon(3e-4));
    joint.axes[0].damping = 0.1;
    // Driven against the damper: the rate approaches torque / damping with the time constant inertia / damping = 0.1
    // s.
    CHECK(angle_about(j.turned({0, 0, 0.02}, 0.5), {0, 0, 1}) == Approx(0.2 * (0.5 - 0.1 * (1 - std::exp(-5.0)))).epsilon(2e-3));
    joint.kind = JointKind::kFixed;
    CHECK(angle_about(j.turned({0, 0, 0.02}, 0.5), {0, 0, 1}) == Approx(0).margin(1e-4));
  }
}

TEST_CASE("A slider moves along its axis up to its stop") {
  const bool to_body = GENERATE(false, true);
  Jointed j(to_body, GENERATE("impulse", "quick"));
  JointDef& joint = add_joint(j.world, JointKind::kPrismatic, j.parent, j.child, {0, 0, 0}, {0, 1, 0});
  joint.axes[0].upper = 0.3;
  joint.axes[0].friction = 0.5;
  Solver s(j.world, j.settings);
  for (int i = 0; i < 400; ++i) {
    s.add_force(j.child, {1, 0.4, 2}, s.bodies()[0].centre_m);
    s.step();
  }
  CHECK(s.bodies()[0].position_m.norm() < 1e-4);  // held by friction and guide
  for (int i = 0; i < 2000; ++i) {
    s.add_force(j.child, {1, 1.5, 2}, s.bodies()[0].centre_m);
    s.step();
  }
  CHECK(s.bodies()[0].position_m.y() == Approx(0.3).margin(0.002));
  CHECK(std::hypot(s.bodies()[0].position_m.x(), s.bodies()[0].position_m.z()) < 1e-4);
}

TEST_CASE("A driven damper turns at torque over damping for any inertia") {
  Settings settings;
  settings.solver = GENERATE("impulse", "quick");
  for (const double inertia : {1e-2, 1e-4, 1e-6}) {
    WorldDef w = empty_world(0);
    const int rotor = add_body(w, "rotor", 0.1, Eigen::Matrix3d::Identity() * inertia, at(0, 0, 0));
    JointDef& joint = add_joint(w, JointKind::kRevolute, -1, rotor, {0, 0, 0}, {0, 0, 1});
    joint.axes[0].damping = 1e-2;
    Solver s(w, settings);
    for (int i = 0; i < 12000; ++i) {
      s.add_force(rotor, {0, 0.01, 0}, s.bodies()[0].centre_m + Vector3d(1, 0, 0));
      s.add_force(rotor, {0, -0.01, 0}, s.bodies()[0].centre_m - Vector3d(1, 0, 0));
      s.step();
    }
    CHECK(s.bodies()[0].spin_rad_s.z() == Approx(2).epsilon(1e-3));
  }
}

TEST_CASE("A passive joint force neither gains energy nor overshoots for any stiffness and damping") {
  for (const double stiffness : {0.0, 1.0, 1e4, 1e9})
    for (const double damping : {0.0, 1e-3, 1.0, 1e6}) {
      const double inertia = 0.01;
      double q = 0.1, v = 0, energy = 0.5 * stiffness * q * q;
      for (int i = 0; i < 2000; ++i) {
        v += kStep * ode::passive_force(q, v, stiffness, 0, damping, inertia, kStep) / inertia;
        q += kStep * v;
        const double now = 0.5 * inertia * v * v + 0.5 * stiffness * q * q;
        INFO(stiffness << " " << damping);
        REQUIRE(now <= energy * (1 + 1e-9) + 1e-15);
        energy = now;
      }
    }
}
