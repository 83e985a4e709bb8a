// Penalty contact against closed forms: the spring and damper of the shell, explicit and implicit.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/sim_node/support/articulated_trees.h"
#include "tests/sim_node/support/toys.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;
using impulse::Penalty;

namespace {

constexpr double kThickness_m = 0.005, kMass_kg = 0.1, kRadius_m = 0.02;

impulse::ContactLaw law(double k, double d, bool is_explicit) {
  impulse::ContactLaw law;
  law.penalty = {k, d, kThickness_m, is_explicit};
  return law;
}

// A ball at a given depth in the shell of a floor.
struct Pressed {
  Toys toys;
  int ball;
  double h;
  Pressed(double k, double d, bool is_explicit, double inside_m, double h, double g = kToyG)
      : toys(law(k, d, is_explicit)), h(h) {
    toys.gravity_m_s2 = {0, 0, -g};
    toys.plane({0, 0, 1}, {0, 0, 0});
    ball = toys.ball(kMass_kg, kRadius_m, {0, 0, kRadius_m + kThickness_m - inside_m});
  }
  double inside_m() const { return kThickness_m - (toys.motion(ball).centre_m.z() - kRadius_m); }
  double step() {
    toys.step(h);
    return inside_m();
  }
};

// Largest amplitude about the resting depth, relative to the first, within a number of steps.
double growth(double k, double d, bool is_explicit, double h, double g, int steps) {
  const double rest = kMass_kg * g / k, first = 0.01 * rest;
  Pressed p(k, d, is_explicit, rest + first, h, g);
  double max = 0;
  for (int i = 0; i < steps; ++i) max = std::max(max, std::abs(p.step() - rest));
  return max / first;
}

}  // namespace

TEST_CASE("A ball in the penalty shell oscillates at the square root of k over m") {
  const bool is_explicit = GENERATE(true, false);
  const double k = 1000, rest = kMass_kg * kToyG / k, first = 0.0003, omega = std::sqrt(k / kMass_kg);
  // Steps short enough that backward Euler loses little: its decay is h omega^2 / 2 = 0.05/s.
  const double h = 1e-5;
  Pressed p(k, 0, is_explicit, rest + first, h);
  double worst = 0;
  for (int n = 1; n <= 20000; ++n) {
    p.step();
    // Both start half a step off: the velocity at rest is that of half a step earlier.
    worst = std::max(worst, std::abs(p.inside_m() - rest - first * std::cos(omega * (n + 0.5) * h)));
  }
  // 3 oscillations: the phase h omega / 2, and the decay 0.05/s * 0.2 s.
  CHECK(worst < first * (0.012 + h * omega));
}

TEST_CASE("A ball rests where the spring carries its weight, a box at a quarter of that depth") {
  const bool is_explicit = GENERATE(true, false);
  const double k = 2000, d = 5;
  Toys toys(law(k, d, is_explicit));
  toys.plane({0, 0, 1}, {0, 0, 0});
  const int ball = toys.ball(kMass_kg, kRadius_m, {0, 0, kRadius_m + kThickness_m});
  const int box = toys.box(0.4, {0.1, 0.1, 0.04}, Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0.025)));
  for (int i = 0; i < 3000; ++i) toys.step(0.001);
  CHECK(kThickness_m - (toys.motion(ball).centre_m.z() - kRadius_m) == Approx(kMass_kg * kToyG / k).epsilon(1e-9));
  CHECK(kThickness_m - (toys.motion(box).centre_m.z() - 0.02) == Approx(0.4 * kToyG / (4 * k)).epsilon(1e-9));
  CHECK(toys.force_N() == Approx((kMass_kg + 0.4) * kToyG).epsilon(1e-9));
}

TEST_CASE("The damper dissipates the energy given by d") {
  const bool is_explicit = GENERATE(true, false);
  const double k = 1000, d = 2, rest = kMass_kg * kToyG / k, first = 0.0003, h = 1e-5;
  const double omega = std::sqrt(k / kMass_kg), decay = d / (2 * kMass_kg),
               swing = std::sqrt(omega * omega - decay * decay);
  Pressed p(k, d, is_explicit, rest + first, h);
  // After whole oscillations x = first exp(-decay t): the energy falls by exp(-2 decay t).
  for (const int swings : {1, 2}) {
    static_cast<void>(swings);
    const int steps = static_cast<int>(std::lround(2 * std::numbers::pi / swing / h));
    const double before = p.inside_m() - rest;
    for (int i = 0; i < steps; ++i) p.step();
    const double ratio = (p.inside_m() - rest) / before;
    CHECK(ratio * ratio == Approx(std::exp(-2 * decay * steps * h)).epsilon(0.01));
  }
}

TEST_CASE("Each integration form follows its recurrence to rounding") {
  const double h = GENERATE(0.001, 0.004);
  const double k = 1000, d = 2, rest = kMass_kg * kToyG / k, m = kMass_kg, g = kToyG;
  Pressed by_force(k, d, true, 1.2 * rest, h), by_end(k, d, false, 1.2 * rest, h);
  double x = 1.2 * rest, v = 0, y = x, w = 0;  // into the shell
  double worst = 0;
  for (int n = 0; n < 60; ++n) {
    // Explicit: force from the depth at the start and the velocity of the previous step.
    v += h * g - h / m * std::max(0.0, k * x + d * v);
    x += h * v;
    // Backward Euler: m (w' - w) = h (m g - k (y + h w') - d w').
    w = (w + h * g - h / m * k * y) / (1 + h / m * (h * k + d));
    y += h * w;
    worst = std::max({worst, std::abs(by_force.step() - x), std::abs(by_end.step() - y)});
  }
  CHECK(worst < 1e-12);
}

TEST_CASE("Explicit penalty is stable up to h^2 k + 2 h d = 4 m and unstable beyond") {
  const double h = 1.0 / 60, g = 3 * kToyG;
  const double d = GENERATE(0.0, 1.0, 3.0);
  const double limit = impulse::max_explicit_stiffness_N_m(1 / kMass_kg, d, h);
  CHECK(h * h * limit + 2 * h * d == Approx(4 * kMass_kg));
  // An undamped oscillation reaches 1/sqrt(1 - h^2 k / 4 m) times its initial amplitude: 10 at 99 % of the limit.
  CHECK(growth(0.99 * limit, d, true, h, g, 2000) < 11);
  CHECK(growth(1.01 * limit, d, true, h, g, 2000) > 20);
}

TEST_CASE("Implicit penalty never exceeds its initial amplitude for any stiffness") {
  const double times = GENERATE(1.0, 10.0, 1e3, 1e6);  // times the stiffest explicit one
  const double h = GENERATE(0.001, 1.0 / 60);
  const double k = times * impulse::max_explicit_stiffness_N_m(1 / kMass_kg, 0, h);
  CHECK(growth(k, GENERATE(0.0, 5.0), false, h, kToyG, 500) <= 1.0 + 1e-6);
}

TEST_CASE("The penalty force of a new contact grows continuously from zero") {
  const bool is_explicit = GENERATE(true, false);
  const double k = 4000, d = 5, speed = 0.25, h = 1e-4;
  Pressed p(k, d, is_explicit, -0.001, h);
  p.toys.world.free_body(p.ball).velocity_m_s = {0, 0, -speed};
  double before = 0, max = 0, jump = 0;
  for (int i = 0; i < 600; ++i) {
    p.step();
    const double force = p.toys.force_N();
    jump = std::max(jump, std::abs(force - before));
    max = std::max(max, force);
    before = force;
  }
  //
  // f'
  // <= k v + d' v + d a, with d' = d v over the part of the shell in which damping increases, and the largest a that
  // the force allows.
  const double fastest = speed + 0.02;
  const double rate =
      k * fastest + d * fastest * fastest / (impulse::kDampingOnsetShare * kThickness_m) + d * max / kMass_kg;
  CHECK(jump <= h * rate);
  CHECK(max > 3);
}

TEST_CASE("A body too fast for the penalty shell stops at the surface") {
  const bool is_explicit = GENERATE(true, false);
  const double h = GENERATE(0.001, 1.0 / 60);
  const double speed = GENERATE(1.0, 5.0, 20.0);
  Toys toys(law(1000, 1, is_explicit));
  toys.plane({0, 0, 1}, {0, 0, 0});
  const int ball = toys.ball(kMass_kg, kRadius_m, {0, 0, 0.5});
  const int box =
      toys.box(0.4, {0.1, 0.1, 0.04},
               Eigen::Translation3d(1, 0, 0.5) * Eigen::Isometry3d(Eigen::AngleAxisd(0.3, Vector3d::UnitX())));
  for (const int body : {ball, box}) toys.world.free_body(body).velocity_m_s = {0, 0, -speed};
  double min = 1;
  for (int i = 0; i < 0.8 / h; ++i) {
    toys.step(h);
    min = std::min(min, toys.motion(ball).centre_m.z() - kRadius_m);
    for (int corner = 0; corner < 8; ++corner)
      min = std::min(
          min, toys.motion(box)
                     .to_world({corner & 1 ? 0.05 : -0.05, corner & 2 ? 0.05 : -0.05, corner & 4 ? 0.02 : -0.02})
                     .z());
  }
  INFO("h " << h << " speed " << speed << " explicit " << is_explicit);
  CHECK(min > -1e-5);
}

TEST_CASE("Friction in the penalty shell obeys the friction cone") {
  const bool is_explicit = GENERATE(true, false);
  const double theta = 0.3, factor = GENERATE(1.01, 0.8, 0.3), mu = factor * std::tan(theta);
  const double yaw = GENERATE(0.0, 0.4, std::numbers::pi / 4);
  const Eigen::Isometry3d tilt(Eigen::AngleAxisd(theta, Vector3d::UnitY()));
  Toys toys(law(4000, 20, is_explicit));
  toys.plane(tilt.linear() * Vector3d::UnitZ(), {0, 0, 0}, mu);
  const double k = 4000, depth = 0.5 * kToyG * std::cos(theta) / (4 * k);
  const int box = toys.box(
      0.5, {0.1, 0.1, 0.04},
      tilt * Eigen::Translation3d(0, 0, 0.02 + kThickness_m - depth) * Eigen::AngleAxisd(yaw, Vector3d::UnitZ()),
      mu);
  // Until the corners share the weight.
  for (int i = 0; i < 300; ++i) toys.step(0.001);
  const Vector3d start = toys.motion(box).centre_m, first = toys.motion(box).velocity_m_s;
  for (int i = 0; i < 300; ++i) toys.step(0.001);
  const Vector3d along = tilt.linear() * Vector3d::UnitX();
  const double gained = (toys.motion(box).velocity_m_s - first).dot(along);
  INFO("factor " << factor << " yaw " << yaw);
  if (factor > 1)
    CHECK((toys.motion(box).centre_m - start).norm() < 1e-6);
  else
    CHECK(gained == Approx(0.3 * kToyG * (std::sin(theta) - mu * std::cos(theta))).epsilon(0.005));
}

TEST_CASE("Two balls that collide in their shells without damping exchange their speeds") {
  Toys toys(law(1000, 0, true));
  toys.gravity_m_s2.setZero();
  const int a = toys.ball(kMass_kg, kRadius_m, {-0.03, 0, 0}), b = toys.ball(kMass_kg, kRadius_m, {0.03, 0, 0});
  toys.world.free_body(a).velocity_m_s = {0.3, 0, 0};
  for (int i = 0; i < 3000; ++i) toys.step(1e-4);
  // Loss of the steps at the border of the shell: the force of one step, k v h^2 / m of the speed.
  CHECK(toys.motion(a).velocity_m_s.x() == Approx(0).margin(0.3 * 2e-3));
  CHECK(toys.motion(b).velocity_m_s.x() == Approx(0.3).epsilon(2e-3));
  CHECK((toys.motion(a).velocity_m_s + toys.motion(b).velocity_m_s - Vector3d(0.3, 0, 0)).norm() < 1e-12);
}

TEST_CASE("A link on a hinge rests on the shell with all of its weight") {
  const bool is_explicit = GENERATE(true, false);
  const double k = 2000;
  Toys toys(law(k, 5, is_explicit));
  toys.plane({0, 0, 1}, {0, 0, -0.01 - kThickness_m});
  articulated::LinkDef link = rod_link(-1, JointKind::kRevolute, {0, 0, 0}, {1, 0, 0});
  link.axes[0].axis = {0, 1, 0};
  link.gravity_m_s2 = toys.gravity_m_s2;
  const int body = add_system(toys.world, articulated::ArticulatedSystem({link}));
  toys.capsule(body, 0, 0.01, {1, 0, 0}, 0);
  for (int i = 0; i < 4000; ++i) toys.step(0.001);
  // The hinge carries no moment; the depth follows from the spring.
  const double weight = link.mass_kg * kToyG;
  CHECK(toys.force_N() == Approx(weight).epsilon(1e-4));
  CHECK(-toys.motion(body).centre_m.z() == Approx(weight / k).epsilon(1e-3));
}

TEST_CASE("A body that crosses the shell rebounds with its restitution, a slower one keeps its speed") {
  const bool is_explicit = GENERATE(true, false);
  const double k = 1e4, e = 0.6;
  impulse::ContactLaw in_shell = law(k, 0, is_explicit);
  in_shell.penalty.thickness_m = 0.001;
  // The spring stops speeds up to T sqrt(k/m) = 0.32 m/s.
  const double speed = GENERATE(0.05, 0.15, 1.0, 3.0), h = 1e-4;
  Toys toys(in_shell);
  toys.gravity_m_s2.setZero();
  toys.plane({0, 0, 1}, {0, 0, 0}, 0.5, e);
  const int ball = toys.ball(kMass_kg, kRadius_m, {0, 0, kRadius_m + 0.01}, 0.5, e);
  toys.world.free_body(ball).velocity_m_s = {0, 0, -speed};
  double min = 1;
  for (int i = 0; i < 0.03 / speed / h; ++i) {
    toys.step(h);
    min = std::min(min, toys.motion(ball).centre_m.z() - kRadius_m);
  }
  CHECK(min > -1e-6);
  const double back = toys.motion(ball).velocity_m_s.z();
  INFO("speed " << speed << " back " << back);
  if (speed < 0.3) {
    // Backward Euler loses h omega pi / 2 of the speed in half an oscillation: 5 %.
    CHECK(back <= speed * (1 + 1e-3));
    CHECK(back > speed * 0.94);
  } else {
    // The spring gives at most k T^2 / 2 on the way out, except for one step of its force.
    const double step = h * k * in_shell.penalty.thickness_m / kMass_kg;
    CHECK(back >= e * std::sqrt(speed * speed - 0.1) - step);
    CHECK(back <= std::sqrt(e * e * speed * speed + 0.1) + step);
  }
}

TEST_CASE("A body that starts inside the shell is pushed out gently and rests on the spring") {
  const bool is_explicit = GENERATE(true, false);
  const double rise = GENERATE(0.0, 0.02), k = 20000;
  impulse::ContactLaw in_shell = law(k, 5, is_explicit);
  in_shell.penalty.thickness_m = 0.0005;
  in_shell.penalty.rise_m_s = rise;
  Toys toys(in_shell);
  toys.plane({0, 0, 1}, {0, 0, 0});
  const int box = toys.box(0.4, {0.1, 0.1, 0.04}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.02)));
  double fastest = 0;
  for (int i = 0; i < 1500; ++i) {
    toys.step(0.001);
    fastest = std::max(fastest, toys.motion(box).velocity_m_s.z());
  }
  CHECK(toys.motion(box).centre_m.z() - 0.02 == Approx(0.0005 - 0.4 * kToyG / (4 * k)).epsilon(1e-4));
  // Released at once, the spring throws it with up to T sqrt(4 k / m) = 0.22 m/s.
  if (rise > 0)
    CHECK(fastest < 2.1 * rise);
  else
    CHECK(fastest > 0.08);
}

TEST_CASE("A body that arrives from outside always enters the whole shell") {
  const bool is_explicit = GENERATE(true, false);
  double force[2];
  for (const bool gentle : {false, true}) {
    impulse::ContactLaw in_shell = law(4000, 5, is_explicit);
    if (gentle) in_shell.penalty.rise_m_s = 0.02;
    Toys toys(in_shell);
    toys.plane({0, 0, 1}, {0, 0, 0});
    const int ball = toys.ball(kMass_kg, kRadius_m, {0, 0, kRadius_m + 0.01});
    toys.world.free_body(ball).velocity_m_s = {0, 0, -0.3};
    double max = 0;
    for (int i = 0; i < 100; ++i) {
      toys.step(0.001);
      max = std::max(max, toys.force_N());
    }
    force[gentle] = max;
  }
  CHECK(force[0] > 5);
  CHECK(force[1] == force[0]);
}
