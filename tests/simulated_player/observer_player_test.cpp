// Tests of the observer player in a toy world: a ball that rolls on a floor, a hole, and a hand on an impedance arm.
#include "scripts/simulated_player/observer_player.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>

#include "scripts/simulated_player/observer/impedance_arm.h"
#include "scripts/simulated_player/player_choice.h"

using namespace tactus;
using namespace tactus::simulated_player;
using Eigen::Vector3d;

namespace {

constexpr double kToyStep_s = 1e-3, kToyHand_m = 0.008, kToyMass_kg = 0.2, kToyStiffness_N_m = 400;

Rules toy_rules() {
  return {.goals = {{.body = 4, .hole_m = {0.15, 0, 0}, .hole_radius_m = 0.038, .ball_radius_m = 0.032}}, .hand_radius_m = kToyHand_m, .floor_m = {}, .slope_m_s2 = {0, 0, 0}};
}

// The eye of the dark room.
Viewer toy_viewer() {
  Viewer viewer;
  viewer.eye_m = {-1.2, 0, 0.92};
  const Vector3d forward = (Vector3d(0.04, 0, 0.09) - viewer.eye_m).normalized();
  viewer.axes.col(0) = Vector3d(0, -1, 0), viewer.axes.col(2) = forward, viewer.axes.col(1) = viewer.axes.col(0).cross(forward);
  return viewer;
}

struct Conditions {
  double picture_delay_s = 0;
  bool feels = true;
};

struct ToyGame {
  ToyGame(std::uint64_t seed, const Conditions& c) : conditions(c), arm({}, hand, seed), player({}, toy_rules(), toy_viewer(), area, hand, seed) {
    ball = {-0.09 + 0.02 * static_cast<double>(seed % 3), 0.03 * static_cast<double>(seed % 4) - 0.04, 0.032};
  }

  // Time until the ball lies in its hole, s; infinite: not within the limit.
  double play(double limit_s) {
    for (int tick = 0; tick < limit_s / kToyStep_s; ++tick) {
      now_s = tick * kToyStep_s;
      shown.emplace_back(ball, arm.position_m());
      if (tick % 16 == 0) show();
      arm.step(player.step(now_s, arm.position_m(), conditions.feels ? force : Vector3d::Zero()), force, kToyStep_s);
      push();
      path.push_back(arm.position_m());
      if (ball.z() < 0) return now_s;
    }
    return std::numeric_limits<double>::infinity();
  }
  void show() {
    const auto late = static_cast<std::size_t>(std::llround(conditions.picture_delay_s / kToyStep_s));
    if (shown.size() <= late) return;
    const auto& [at, hand_at] = shown[shown.size() - 1 - late];
    Picture picture;
    picture.shown_s = now_s, picture.interval_s = 0.016;
    picture.balls.emplace_back(Picture::Ball{at, at.z() < 0 ? 0 : 400.0});
    picture.hand_m = hand_at;
    player.senses().show(picture, player.gaze_m());
  }
  void push() {
    force.setZero();
    const Vector3d d = ball - arm.position_m();
    const double deep = 0.032 + kToyHand_m - d.norm();
    if (deep > 0) force = -kToyStiffness_N_m * deep * d.normalized();
    speed -= kToyStep_s * (Vector3d(force.x(), force.y(), 0) / (1.4 * kToyMass_kg) + speed);
    ball += kToyStep_s * speed;
    if ((ball - Vector3d(0.15, 0, 0.032)).norm() < 0.025 && speed.norm() < 0.6) ball.z() = -0.07;
  }

  static double area(std::size_t, const Vector3d&) { return 400; }
  Conditions conditions;
  Vector3d hand{-0.2, 0, 0.13}, ball, speed{0, 0, 0}, force{0, 0, 0};
  observer::ImpedanceArm arm;
  ObserverPlayer player;
  std::deque<std::pair<Vector3d, Vector3d>> shown;
  std::vector<Vector3d> path;
  double now_s = 0;
};

}  // namespace

TEST_CASE("An observer pushes a ball into its hole, for several seeds") {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    INFO("seed " << seed);
    CHECK(ToyGame(seed, {}).play(60) < 60);
  }
}

TEST_CASE("The same seed gives an observer the same game, another seed another one") {
  ToyGame one(3, {}), same(3, {}), other(4, {});
  one.play(4), same.play(4), other.play(4);
  CHECK(one.path == same.path);
  CHECK(one.path != other.path);
}

TEST_CASE("Late pictures make the games of an observer slower") {
  double prompt_s = 0, late_s = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    prompt_s += std::min(60.0, ToyGame(seed, {}).play(60));
    late_s += std::min(60.0, ToyGame(seed, {.picture_delay_s = 0.4}).play(60));
  }
  CHECK(late_s > prompt_s);
}

TEST_CASE("An observer who feels no force plays the same game until it touches the ball, and another one after that") {
  ToyGame whole(2, {}), numb(2, {.feels = false});
  whole.play(20), numb.play(20);
  const std::size_t count = std::min(whole.path.size(), numb.path.size());
  std::size_t first = 0;
  while (first < count && whole.path[first] == numb.path[first]) ++first;
  CHECK(first > 1000);  // it travels to the ball first
  CHECK(first < count);
}

TEST_CASE("A percept of a picture depends on the instant and not on the pictures before") {
  const Viewer viewer = toy_viewer();
  ObserverSenses all({}, toy_rules(), viewer, 5), few({}, toy_rules(), viewer, 5);
  Picture picture;
  picture.balls.emplace_back(Picture::Ball{{-0.05, 0.1, 0.032}, 400});
  picture.hand_m = Vector3d(-0.1, 0.1, 0.03);
  int compared = 0;
  for (int frame = 0; frame < 60; ++frame) {
    picture.shown_s = frame / 60.0;
    all.show(picture, {0, 0, 0});
    if (frame % 3 == 0) few.show(picture, {0, 0, 0});
  }
  const auto arrives = [](int frame) { return frame / 60.0 + observer::PlayerParameters{}.visual_latency_s; };
  std::vector<std::pair<double, SightPercept>> seen;
  while (auto p = all.sight.take(10)) seen.push_back(*p);
  while (auto p = few.sight.take(10))
    for (const auto& [at, percept] : seen)
      if (at == p->first) {
        ++compared;
        REQUIRE(percept.balls[0].has_value() == p->second.balls[0].has_value());
        if (percept.balls[0]) CHECK(percept.balls[0]->point_m == p->second.balls[0]->point_m);
        CHECK(*percept.hand_m == *p->second.hand_m);
      }
  CHECK(compared >= 15);
  CHECK(seen.front().first >= arrives(0) - 1e-12);
}

TEST_CASE("A ball that vanishes at its hole is believed to have fallen, and one that is hidden elsewhere is not") {
  const Goal goal = toy_rules().goals[0];
  const Viewer viewer = toy_viewer();
  for (const bool at_hole : {true, false}) {
    BelievedBall ball(goal, viewer, {0, 0, 0.032}, 0.1);
    const Vector3d at = at_hole ? Vector3d(0.15, 0, 0.032) : Vector3d(-0.1, 0.05, 0.032);
    const SightLine line = viewer.line_to(at);
    for (int i = 0; i < 20; ++i) ball.predict({0, 0, 0}), ball.locate(0.1, at, line.away, 0.005, 0.003);
    for (int i = 0; i < 20; ++i) ball.predict({0, 0, 0}), ball.miss(0.1, at_hole ? 0.98 : 0.0);
    CHECK((ball.in_hole() > 0.9) == at_hole);
  }
}

TEST_CASE("The name of a player selects the fixed rules, the typical person or a person of the population") {
  CHECK_FALSE(player_choice("stage_model").observer);
  CHECK(player_choice("observer").number == -1);
  CHECK(player_choice("observer:17").number == 17);
  for (const char* wrong : {"", "observer:", "observer:-1", "observer:1x", "observers", "observer:99999999999"}) CHECK_THROWS_AS(player_choice(wrong), std::runtime_error);
}

TEST_CASE("A box between the eye and a ball hides it, in whole or in part") {
  scene_t scene{};
  body_def_t body{};
  body.is_static = 1, body.tool = -1, body.pose.orientation.w = 1;
  scene.bodies = {body, body};
  scene.body_count = 2;
  visual_def_t box{};
  box.alpha = 1;
  box.shape.body = 0, box.shape.kind = shape_def_t::BOX, box.shape.pose.orientation.w = 1;
  box.shape.size_m = {0.1, 0.4, 0.4};
  scene.visuals = {box};
  scene.visual_count = 1;
  const Occluders occluders(scene);
  const auto share = [&](const Vector3d& at) { return occluders.visible_share({-1, 0, 0}, at, 0.05, 1, [](int) { return Eigen::Isometry3d::Identity(); }); };
  CHECK(share({0.5, 0, 0}) == 0);
  CHECK(share({-0.5, 0, 0}) == 1);
  CHECK(share({0.5, 1, 0}) == 1);
  // The shadow of the near edge, y = 0.2 at x = -0.05, is at y = 0.2 * 1.5 / 0.95 = 0.316.
  const double part = share({0.5, 0.316, 0});
  CHECK(part > 0);
  CHECK(part < 1);
}
