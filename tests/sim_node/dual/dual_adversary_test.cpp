// Stress tests of both groups: a tool with hostile motion, and a thread that gets no time.
#include <catch2/catch.hpp>
#include <random>
#include <tactus/contact_event_t.hpp>

#include "tests/sim_node/support/dual_bench.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

constexpr double kBall_m = 0.03;

// Position of a body of the visual group at an instant within its step: on the chords between its sub-steps.
Vector3d position_in_step(const VisualStep& step, std::size_t unit, sync::Nanoseconds passed) {
  const std::size_t k = step.time_before(passed);
  const Vector3d from = step.states[k][unit].body.centre_m;
  if (k + 1 >= step.times.size()) return from;
  const Vector3d to = step.states[k + 1][unit].body.centre_m;
  const double share =
      sync::to_seconds(passed - step.times[k]) / sync::to_seconds(step.times[k + 1] - step.times[k]);
  return from + share * (to - from);
}

// A tray of balls with random velocities.
WorldDef tray(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> speed(-0.7, 0.7);
  WorldDef w = empty_world();
  add_floor(w, 0.3, 0.6);
  for (const auto& [x, y, sx, sy] : {std::tuple{0.35, 0.0, 0.05, 0.8}, std::tuple{-0.35, 0.0, 0.05, 0.8},
                                     std::tuple{0.0, 0.35, 0.8, 0.05}, std::tuple{0.0, -0.35, 0.8, 0.05}}) {
    const int wall = add_body(w, "wall", 0, Eigen::Matrix3d::Identity(), at(x, y, 0.2));
    add_shape(w, wall, ShapeKind::kBox, {sx, sy, 0.4}, 0.3, 0.6);
  }
  for (int i = 0; i < 16; ++i) {
    const int ball =
        add_ball(w, 0.1, kBall_m, {0.15 * (i % 4) - 0.22, 0.15 * (i / 4) - 0.22, 0.05 + 0.01 * i}, 0.3, 0.6);
    w.bodies[static_cast<std::size_t>(ball)].velocity_m_s = {speed(random), speed(random), 0};
  }
  return w;
}

}  // namespace

TEST_CASE("Bodies of the two groups never touch for any motion of the hand") {
  const double acceleration = GENERATE(10.0, 100.0, 300.0);
  const unsigned seed = GENERATE(1u, 2u);
  CAPTURE(acceleration, seed);
  Dual d(tray(seed));
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Vector3d direction(1, 0, 0);
  double nearest_m = 1;
  int moved_over = 0, pushed = 0;
  for (int i = 0; i < 1500; ++i) {
    GroupTool& tool = d.tools[0];
    if (i == 0) tool = {{0, 0, 0.05}, Vector3d::Zero(), 0.01};
    // Bang-bang control with bounded speed, inside the tray, towards one ball after the other.
    if (i % 47 == 0) {
      const Vector3d at_ball = d.body(5 + static_cast<int>(random() % 16)).centre_m - tool.centre_m;
      direction = (at_ball.normalized() + 0.3 * Vector3d(normal(random), normal(random), normal(random))).normalized();
    }
    tool.velocity_m_s += 0.001 * acceleration * direction;
    if (tool.velocity_m_s.norm() > 1) tool.velocity_m_s.normalize();
    tool.centre_m += 0.001 * tool.velocity_m_s;
    for (int k = 0; k < 3; ++k) {
      const double least = k == 2 ? 0.02 : -0.3, most = k == 2 ? 0.05 : 0.3;
      if (tool.centre_m[k] < least || tool.centre_m[k] > most) tool.velocity_m_s[k] = 0;
      tool.centre_m[k] = std::clamp(tool.centre_m[k], least, most);
    }
    // It pushes the balls that it meets with a stiffness of 2 kN/m.
    for (const int body : d.groups.haptic()) {
      const Vector3d apart = d.body(body).centre_m - tool.centre_m;
      const double depth = kBall_m + 0.01 - apart.norm();
      if (depth <= 0) continue;
      d.groups.add_force(body, std::min(20.0, 2000 * depth) * apart.normalized(), d.body(body).centre_m);
      ++pushed;
    }
    d.tick();
    const VisualStep& step = *d.groups.step();
    const sync::Nanoseconds passed = d.now() - (d.groups.step_ends() - step.task.length);
    for (std::size_t u = 0; u < step.units.size(); ++u) {
      const int body = step.bodies[u];
      if (d.groups.is_haptic(body)) continue;
      const Vector3d place = position_in_step(step, u, passed);
      for (const int other : d.groups.haptic())
        nearest_m = std::min(nearest_m, (d.body(other).centre_m - place).norm() - 2 * kBall_m);
      // Nor does the tool touch a body outside the haptic group.
      nearest_m = std::min(nearest_m, (tool.centre_m - place).norm() - kBall_m - tool.radius_m);
    }
    moved_over += d.groups.haptic().empty() ? 0 : 1;
  }
  CHECK(nearest_m > 0);
  CHECK(pushed > 10);
  CHECK(moved_over > 100);
  // Nothing left the tray, and no ball sank into the floor.
  for (const BodyMotion& m : d.groups.motions())
    if (m.moves()) CHECK((m.centre_m.head<2>().cwiseAbs().maxCoeff() < 0.36 && m.centre_m.z() > kBall_m - 1e-5));
}

TEST_CASE("A late visual step holds its bodies, is counted and delays no tick") {
  WorldDef w = empty_world();
  const int ball = add_ball(w, 1, 0.05, {0, 0, 10});
  for (int i = 0; i < 60; ++i) add_ball(w, 1, 0.05, {1.0 + 0.2 * (i % 8), 0.2 * (i / 8), 10});
  Settings settings = dual_settings();
  settings.visual_thread = "own";
  Dual d(w, settings);
  // Ticks run as fast as they can, so that the thread is far behind.
  std::int64_t held = 0;
  double last = 10;
  for (int i = 0; i < 3000; ++i) {
    d.tick();
    const double z = d.body(ball).centre_m.z();
    if (d.groups.held_ticks() > held && i > 0 && d.groups.held_ticks() > 1) CHECK(z <= last);
    held = d.groups.held_ticks();
    last = z;
  }
  CHECK(d.groups.late_steps() > 0);
  CHECK(d.groups.held_ticks() >= d.groups.late_steps());
  // It falls on its parabola during the time in which it is not held.
  const double fell_s =
      sync::to_seconds(d.groups.step()->begins.time_since_epoch() + d.groups.step()->task.length);
  CHECK(d.groups.step()->states.back()[0].body.centre_m.z() == Approx(10 - kG / 2 * fell_s * fell_s).margin(1e-9));
}

TEST_CASE("A push moves a body into the haptic group, and values set on it persist") {
  WorldDef w = empty_world(0);
  const int ball = add_ball(w, 0.2, 0.05, {0, 0, 1});
  Dual d(w);
  d.run(20);
  CHECK_FALSE(d.groups.is_haptic(ball));
  CHECK(d.groups.set_pose(ball, at(0.5, 0, 2)));
  CHECK(d.groups.set_velocity(ball, {0, 1, 0}));
  d.run(2);
  CHECK(d.groups.is_haptic(ball));
  CHECK(d.body(ball).centre_m.x() == Approx(0.5));
  CHECK(d.body(ball).centre_m.y() == Approx(0.001).margin(0.0011));
  for (int i = 0; i < 25; ++i) {
    d.groups.add_wrench(ball, {1, 0, 0}, {0.001, 0, 0});
    d.tick();
  }
  CHECK(d.body(ball).velocity_m_s.x() == Approx(0.025 / 0.2).epsilon(1e-9));
  d.run(120);
  CHECK_FALSE(d.groups.is_haptic(ball));
  CHECK(d.body(ball).velocity_m_s.y() == Approx(1));
  // Gravity acts on both groups.
  CHECK(d.groups.apply({.kind = impulse::SceneChange::kGravity, .values = {0, 0, -1}}));
  const double before = d.groups.step()->end[static_cast<std::size_t>(ball)].velocity_m_s.z();
  d.run(200);
  CHECK(d.groups.step()->end[static_cast<std::size_t>(ball)].velocity_m_s.z() ==
        Approx(before - 0.2).margin(0.04));
}

TEST_CASE("A visual group on its own thread exchanges bodies and applies changes") {
  WorldDef w = empty_world();
  add_floor(w, 0.5, 0.3);
  for (int i = 0; i < 24; ++i)
    add_ball(w, 0.2, kBall_m, {0.1 * (i % 6), 0.1 * (i / 6), kBall_m + 0.02 * (i % 3)}, 0.4, 0.5);
  Settings settings = dual_settings();
  settings.visual_thread = "own";
  Dual d(w, settings);
  int here = 0, there = 0;
  // Ticks run as fast as they can, so that about half of the steps are late.
  for (int i = 0; i < 4000; ++i) {
    const double t = 0.001 * i;
    d.tools[0].centre_m = {0.25 + 0.3 * std::sin(3 * t), 0.15 + 0.2 * std::cos(5 * t), 0.03};
    d.tools[0].velocity_m_s = {0.9 * std::cos(3 * t), -std::sin(5 * t), 0};
    const int ball = 1 + i % 24;
    if (i % 50 == 7) d.groups.add_force(ball, {0, 0.5, 3}, d.body(ball).centre_m);
    if (i % 300 == 11) CHECK(d.groups.set_velocity(ball, {0.1, 0, 0.5}));
    if (i % 200 == 3)
      CHECK(d.groups.apply({.kind = impulse::SceneChange::kFriction, .body = ball, .values = {0.3, 0, 0}}));
    if (i % 500 == 250) {
      StateArchive saved;
      d.groups.archive(saved);
      StateArchive back{std::span<const std::uint8_t>(saved.bytes())};
      d.groups.archive(back);
      CHECK(back.at_end());
    }
    d.tick();
    (d.groups.is_haptic(ball) ? here : there) += 1;
    CHECK(d.groups.look_ahead() != nullptr);
  }
  CHECK(here > 100);
  CHECK(there > 100);
  CHECK(d.count(contact_event_t::BEGIN) > 20);
  for (const BodyMotion& m : d.groups.motions())
    if (m.moves()) CHECK((m.centre_m.allFinite() && m.centre_m.z() > kBall_m - 1e-5));
}
