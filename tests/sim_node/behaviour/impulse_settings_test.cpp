// Changes of properties during an impulse simulation, against closed forms.
#include <catch2/catch.hpp>

#include "sim_node/behaviour/solver.h"
#include "tests/sim_node/support/small_worlds.h"
#include "tests/sim_node/support/solver_steps.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using impulse::SceneChange;
using Eigen::Vector3d;

namespace {

Settings by_impulse() {
  Settings s;
  s.solver = "impulse";
  s.detector = "auto";
  return s;
}

void set_gravity(Solver& s, const Vector3d& g) { s.apply({.kind = SceneChange::kGravity, .values = g}); }
bool set_mass(Solver& s, int body, double mass_kg) {
  return s.apply({.kind = SceneChange::kMass, .body = body, .values = {mass_kg, 0, 0}});
}
bool set_motor(Solver& s, const std::string& joint, int axis, double effort, double velocity) {
  return s.apply({.kind = SceneChange::kMotor, .joint = joint, .axis = axis, .values = {effort, velocity, 0}});
}
void set_restitution(Solver& s, int body, double restitution) {
  s.apply({.kind = SceneChange::kRestitution, .body = body, .values = {restitution, 0, 0}});
}

// A rod of 0.4 m and 0.5 kg that hangs on its end, without gravity.
constexpr double kLength = 0.4, kMass = 0.5, kAcross = kMass * kLength * kLength / 12;
constexpr double kAtPivot = kAcross + kMass * kLength * kLength / 4;
WorldDef hanging_rod(JointKind kind) {
  WorldDef w = empty_world(0);
  add_body(w, "rod", kMass, Eigen::Vector3d(kAcross, kAcross, kAcross).asDiagonal(), at(0, 0, -kLength / 2));
  add_joint(w, kind, -1, 0, {0, 0, 0}, {0, 1, 0}, {1, 0, 0});
  return w;
}

}  // namespace

TEST_CASE("The impulse solver accepts new gravity, mass, pose, velocity and spin of free bodies") {
  WorldDef w = empty_world();
  const int ball = add_ball(w, 0.2, 0.03, {0, 0, 5});
  add_floor(w);
  Solver s(w, by_impulse());
  SECTION("gravity applies from the next step on") {
    run(s, 0.1);
    const double z = body(s, ball).centre_m.z(), v = -kG * 0.1;
    set_gravity(s, {1, 0, -2});
    run(s, 0.1);
    CHECK(body(s, ball).centre_m.z() == Approx(z + v * 0.1 - 0.01).margin(1e-9));
    CHECK(body(s, ball).centre_m.x() == Approx(0.005).margin(1e-9));
  }
  SECTION("the acceleration by a force follows the new mass") {
    set_gravity(s, {0, 0, 0});
    REQUIRE(set_mass(s, ball, 0.8));
    for (int i = 0; i < 100; ++i) {
      s.add_force(ball, {0.4, 0, 0}, body(s, ball).centre_m);
      s.step();
    }
    // A new force counts as if it had acted half a step before: one part in 100 steps.
    CHECK(body(s, ball).centre_m.x() == Approx(0.5 * 0.5 * 0.01 * 1.01).epsilon(1e-9));
    CHECK(body(s, ball).inverse_mass_1_kg == Approx(1.25));
  }
  SECTION("a pose takes effect at once, also on contacts") {
    CHECK(s.contacts().empty());
    REQUIRE(s.set_pose(ball, at(1, 2, 0.03)));
    CHECK(body(s, ball).centre_m.x() == 1);
    REQUIRE(s.contacts().size() == 1);
    CHECK(s.contacts()[0].points[0].depth_m == Approx(0).margin(1e-9));
  }
  SECTION("velocity and spin take effect at once") {
    REQUIRE(s.set_velocity(ball, {1, 2, 3}));
    REQUIRE(s.set_spin(ball, {0, 0, 7}));
    run(s, 0.1);
    CHECK((body(s, ball).centre_m - Vector3d(0.1, 0.2, 5.3 - kG * 0.005)).norm() < 1e-9);
    CHECK(body(s, ball).spin_rad_s.z() == Approx(7));
  }
  SECTION("a static body rejects mass, pose, velocity and spin") {
    CHECK_FALSE(set_mass(s, ball + 1, 1));
    CHECK_FALSE(s.set_pose(ball + 1, at(0, 0, 0)));
    CHECK_FALSE(s.set_velocity(ball + 1, {1, 0, 0}));
    CHECK_FALSE(s.set_spin(ball + 1, {1, 0, 0}));
  }
}

TEST_CASE("The impulse solver accepts new friction and restitution") {
  WorldDef w = empty_world();
  add_floor(w, 0.4, 1);
  const int box = add_box(w, 1, {0.1, 0.1, 0.1}, at(0, 0, 0.05 + 1e-5), 0.4, 0);
  const int ball = add_ball(w, 0.2, 0.03, {1, 0, 0.53}, 0.4, 0);
  Solver s(w, by_impulse());
  s.apply({.kind = SceneChange::kFriction, .body = box, .values = {0.1, 0, 0}});
  set_restitution(s, ball, 0.8);
  s.set_velocity(box, {1, 0, 0});
  run(s, 0.2);
  // The geometric mean with the floor's.
  CHECK(body(s, box).velocity_m_s.x() == Approx(1 - 0.2 * kG * 0.2).epsilon(0.01));
  double top = 0;
  for (int i = 0; i < 600; ++i) {
    s.step();
    if (body(s, ball).velocity_m_s.z() > 0) top = std::max(top, body(s, ball).centre_m.z() - 0.03);
  }
  CHECK(top == Approx(0.64 * 0.5).epsilon(1e-3));
}

TEST_CASE("In the impulse solver a new velocity of a link acts like an impulse of its momentum") {
  const bool at_start = GENERATE(true, false);
  WorldDef w = hanging_rod(JointKind::kRevolute);
  if (at_start) w.bodies[0].velocity_m_s = {-2, 0.7, 0.3};
  Solver s(w, by_impulse());
  if (!at_start) REQUIRE(s.set_velocity(0, {-2, 0.7, 0.3}));
  run(s, 0.05);
  // Angular momentum about the pivot: m v L / 2, about y. The centre hangs below.
  CHECK(body(s, 0).spin_rad_s.y() == Approx(kMass * 2 * kLength / 2 / kAtPivot).epsilon(1e-6));
  CHECK(body(s, 0).spin_rad_s.head<1>().norm() < 1e-9);
  if (at_start) return;
  const double before = body(s, 0).spin_rad_s.y();
  REQUIRE(s.set_spin(0, {0, before + 3, 0}));
  s.step();
  CHECK(body(s, 0).spin_rad_s.y() == Approx(before + kAcross * 3 / kAtPivot).epsilon(1e-4));
}

TEST_CASE("The impulse solver accepts new motors and dry friction of joints") {
  WorldDef w = hanging_rod(JointKind::kRevolute);
  Solver s(w, by_impulse());
  REQUIRE(set_motor(s, "joint", 0, 0.2, 100));
  run(s, 0.1);
  CHECK(body(s, 0).spin_rad_s.y() == Approx(0.2 * 0.1 / kAtPivot).epsilon(0.01));
  const double rate = body(s, 0).spin_rad_s.y();
  REQUIRE(set_motor(s, "joint", 0, 0, 0));
  REQUIRE(s.apply({.kind = SceneChange::kJointFriction, .joint = "joint", .values = {0.05, 0, 0}}));
  run(s, 0.1);
  CHECK(body(s, 0).spin_rad_s.y() == Approx(rate - 0.05 * 0.1 / kAtPivot).epsilon(0.01));
  run(s, 1);
  CHECK(body(s, 0).spin_rad_s.norm() < 1e-9);
  CHECK_FALSE(set_motor(s, "joint", 1, 1, 1));
  CHECK_FALSE(set_motor(s, "no such", 0, 1, 1));
}

TEST_CASE("In the impulse solver dry friction of a ball joint is equal about every axis") {
  // Held at its centre, with equal inertia about all axes.
  WorldDef w = empty_world(0);
  const double inertia = 0.01;
  add_body(w, "knob", 1, inertia * Eigen::Matrix3d::Identity(), at(0, 0, 0));
  add_joint(w, JointKind::kBall, -1, 0, {0, 0, 0}, {1, 0, 0}).axes[0].friction = 0.02;
  const Vector3d direction =
      GENERATE(Vector3d(1, 0, 0), Vector3d(1, 1, 0), Vector3d(1, -2, 0.5), Vector3d(1, 1, 1)).normalized();
  Solver s(w, by_impulse());
  REQUIRE(s.set_spin(0, 4 * direction));
  run(s, 1);
  const Vector3d spin = body(s, 0).spin_rad_s;
  CHECK(spin.dot(direction) == Approx(4 - 0.02 / inertia).epsilon(0.005));
  CHECK((spin - spin.dot(direction) * direction).norm() < 0.01);
  run(s, 1.1);
  CHECK(body(s, 0).spin_rad_s.norm() < 1e-6);
}

TEST_CASE("In the impulse solver the effective mass at the tip of a hanging rod follows from its lever arm") {
  WorldDef w = hanging_rod(JointKind::kRevolute);
  Solver s(w, by_impulse());
  CHECK(s.mobility(0, {0, 0, -kLength}, {1, 0, 0}) == Approx(kLength * kLength / kAtPivot));
  CHECK(s.mobility(0, {0, 0, -kLength}, {0, 1, 0}) == Approx(0).margin(1e-12));
  CHECK(s.mobility(0, {0, 0, -kLength}, {0, 0, 1}) == Approx(0).margin(1e-12));
}

TEST_CASE("The impulse solver restores changed properties with a state") {
  WorldDef w = hanging_rod(JointKind::kRevolute);
  const int ball = add_ball(w, 0.2, 0.03, {1, 0, 1});
  add_floor(w);
  Solver s(w, by_impulse()), fresh(w, by_impulse());
  set_gravity(s, {0, 0, -3});
  set_mass(s, ball, 0.5);
  set_motor(s, "joint", 0, 0.3, 5);
  set_restitution(s, ball, 0.5);
  run(s, 0.05);
  StateArchive out;
  s.archive(out);
  StateArchive in(out.bytes());
  fresh.archive(in);
  CHECK(in.at_end());
  run(s, 0.8);
  run(fresh, 0.8);
  for (std::size_t i = 0; i < s.bodies().size(); ++i) {
    CHECK(s.bodies()[i].centre_m == fresh.bodies()[i].centre_m);
    CHECK(s.bodies()[i].velocity_m_s == fresh.bodies()[i].velocity_m_s);
    CHECK(s.bodies()[i].inverse_mass_1_kg == fresh.bodies()[i].inverse_mass_1_kg);
  }
}
