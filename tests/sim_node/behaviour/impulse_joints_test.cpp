#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sim_node/support/articulated_trees.h"
#include "tests/sim_node/support/toys.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

constexpr double kWheelStep_s = 0.001;

// A wheel of 0.01 kg m^2 on an axle along z.
struct Wheel {
  JointAxis axis;
  double inertia = 0.01;
  impulse::World world;
  int body = -1;

  void build() {
    articulated::LinkDef l;
    l.joint = JointKind::kRevolute;
    l.axes[0] = axis;
    l.inertia_kg_m2 = inertia * Eigen::Matrix3d::Identity();
    body = add_system(world, articulated::ArticulatedSystem({l}));
  }
  void run(double seconds, double torque = 0) {
    set_torque(world.system_of(body), 0, torque);
    for (int i = 0; i < static_cast<int>(std::lround(seconds / kWheelStep_s)); ++i) world.step({}, kWheelStep_s);
  }
  double angle() { return world.system_of(body).state().positions[0]; }
  double rate() { return world.system_of(body).state().rates[0]; }
};

}  // namespace

TEST_CASE("A driven fan approaches its equilibrium speed exponentially with drag and dry friction") {
  Wheel fan;
  fan.inertia = 1e-3;
  fan.axis.damping = 4e-3;
  fan.axis.friction = 5e-3;
  fan.build();
  for (int i = 0; i < 4; ++i) {
    fan.run(0.25, 20e-3);
    const double t = 0.25 * (i + 1);
    // Friction acts at the start of each step, the torque during all of it. At the end of a step the rate is half of
    // friction's share, h * 5 mN m / 2 I = 2.5 mrad/s, above the mean.
    CHECK(fan.rate() == Approx(3.75 * (1 - std::exp(-4 * t))).margin(3e-3));
  }
  SECTION("a torque within friction does not move it") {
    fan.run(4, 0);
    CHECK(std::abs(fan.world.motions()[0].spin_rad_s.z()) < 1e-9);
    const double before = fan.angle();
    fan.run(1, 4.9e-3);
    CHECK(fan.angle() == Approx(before).margin(1e-9));
  }
}

TEST_CASE("A motor reaches and keeps its speed against friction") {
  Wheel w;
  w.axis.motor_velocity = 3;
  w.axis.motor_effort = 0.05;
  w.axis.friction = GENERATE(0.0, 0.02);
  const double friction = w.axis.friction;
  w.build();
  w.run(0.2);
  CHECK(w.rate() == Approx((0.05 - friction) / 0.01 * 0.2).epsilon(1e-9));
  w.run(2);
  CHECK(w.rate() == Approx(3).epsilon(1e-9));
}

TEST_CASE("A joint stop holds a driven joint on both sides") {
  Wheel w;
  w.axis.lower = -0.5;
  w.axis.upper = 0.7;
  w.build();
  w.run(3, 0.05);
  CHECK(w.angle() == Approx(0.7).margin(1e-6));
  w.run(3, -0.05);
  CHECK(w.angle() == Approx(-0.5).margin(1e-6));
}

TEST_CASE("Springs settle at equilibrium for any stiffness and damping") {
  Wheel w;
  SECTION("stiff springs gain no energy") {
    w.axis.stiffness = GENERATE(1e3, 1e5, 1e9);
    w.axis.damping = GENERATE(0.0, 1.0, 1e4);
    const bool stuck = w.axis.damping > w.axis.stiffness;  // takes longer than the test
    w.axis.reference = 0.1;
    w.build();
    double largest = 0;
    for (int i = 0; i < 2000; ++i) {
      w.world.step({}, kWheelStep_s);
      largest = std::max(largest, std::abs(w.angle() - 0.1));
    }
    CHECK(largest <= 0.1 + 1e-12);
    if (!stuck) CHECK(w.angle() == Approx(0.1).margin(2e-3));
  }
  SECTION("a soft spring oscillates with its period") {
    w.axis.stiffness = 4;
    w.axis.reference = 0.1;
    w.build();
    w.run(1);
    CHECK(w.angle() == Approx(0.1 * (1 - std::cos(20.0))).margin(1e-7));
  }
  SECTION("a driven damper turns at torque over damping for any inertia") {
    w.inertia = GENERATE(1e-2, 1e-4, 1e-6);
    w.axis.damping = 1e-2;
    w.build();
    w.run(12, 0.02);
    CHECK(w.world.motions()[0].spin_rad_s.z() == Approx(2).epsilon(1e-3));
  }
}

TEST_CASE("A chain that falls on the floor rests with its weight shared between floor and hook") {
  Toys toys;
  toys.plane({0, 0, 1}, {0, 0, 0}, 0.6);
  std::vector<articulated::LinkDef> links;
  for (int i = 0; i < 8; ++i) {
    links.push_back(rod_link(i - 1, JointKind::kUniversal, {0, 0, 0.5 - 0.1 * i}, {0, 0, -1}));
    links.back().axes[0].axis = {1, 0, 0};
    links.back().axes[1].axis = {0, 1, 0};
    for (JointAxis& a : links.back().axes) a.damping = 2e-3;
  }
  // Folded, so that no link is below the floor at the start.
  articulated::ArticulatedSystem system(links, kWheelStep_s);
  auto state = system.state();
  state.positions[7] = 1.2;
  state.positions[9] = 0.5;
  system.set_state(state);
  const int chain = add_system(toys.world, std::move(system));
  for (int i = 0; i < 8; ++i) toys.capsule(chain + i, 0.08, 0.01, {0, 0, 1}, 0.6);
  for (int i = 0; i < 6000; ++i) toys.step(kWheelStep_s);
  double fastest = 0;
  for (int i = 0; i < 8; ++i) fastest = std::max(fastest, toys.motion(chain + i).velocity_m_s.norm());
  CHECK(fastest < 5e-3);
  CHECK(toys.min_gap_m() > -5e-4);
  double force = 0;
  for (int i = 0; i < 100; ++i) {
    toys.step(kWheelStep_s);
    force += toys.force_N() / 100;
  }
  CHECK(force > 0.05 * kToyG);
  CHECK(force < 8 * 0.05 * kToyG);
}

TEST_CASE("Boxes and links carry each other's weight in one solve") {
  SECTION("a lever with a ball on each arm balances") {
    Toys toys;
    articulated::LinkDef lever;
    lever.joint = JointKind::kRevolute;
    lever.axes[0].axis = {0, 1, 0};
    lever.mass_kg = 0.2;
    lever.inertia_kg_m2 = Eigen::Vector3d(1e-4, 2e-3, 2e-3).asDiagonal();
    lever.gravity_m_s2 = kDown;
    lever.axes[0].friction = 1e-3;
    const int body = add_system(toys.world, articulated::ArticulatedSystem({lever}));
    toys.capsule(body, 0.6, 0.01, {1, 0, 0}, 0.8);
    const int left = toys.ball(0.1, 0.02, {-0.2, 0, 0.03}, 0.8), right = toys.ball(0.2, 0.02, {0.1, 0, 0.03}, 0.8);
    for (int i = 0; i < 500; ++i) toys.step(kWheelStep_s);
    CHECK(std::abs(toys.world.system_of(body).state().positions[0]) < 1e-6);
    CHECK(toys.force_N() == Approx(0.3 * kToyG).epsilon(1e-6));
    CHECK(toys.motion(left).centre_m.z() == Approx(0.03).margin(1e-6));
    CHECK(toys.motion(right).centre_m.z() == Approx(0.03).margin(1e-6));
  }
}
