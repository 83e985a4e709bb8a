// Tests of the simulated player in a toy world of balls and holes.
#include "scripts/simulated_player/player.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <utility>

using namespace tactus::simulated_player;
using Eigen::Vector3d;

namespace {

constexpr double kPlayerStep_s = 1e-3;
constexpr double kHand_m = 0.008;

Rules one_ball() { return {.goals = {{.body = 4, .hole_m = {0.15, 0, 0}, .hole_radius_m = 0.03, .ball_radius_m = 0.025}}, .hand_radius_m = kHand_m}; }
Rules two_balls() {
  Rules rules = one_ball();
  rules.goals.push_back({.body = 5, .hole_m = {0.15, 0.3, 0}, .hole_radius_m = 0.04, .ball_radius_m = 0.03});
  return rules;
}

// A world of balls that stay where they are pushed, on a plane, and fall at the place of their hole; and a hand at its commanded position.
struct ToyWorld {
  explicit ToyWorld(Rules r, std::vector<Vector3d> at) : rules(std::move(r)), balls(std::move(at)), player(rules, {}) {}

  // True when all balls are in their holes within `seconds` of simulated time.
  bool play(double seconds, const std::function<void(Percept&)>& sense = [](Percept&) {}) {
    for (const double end = time_s + seconds; time_s < end; time_s += kPlayerStep_s) {
      Percept p;
      p.time_s = time_s, p.hand_m = hand, p.force_N = force;
      for (const Vector3d& ball : balls) p.balls_m.emplace_back(ball);
      p.fell.assign(balls.size(), false);
      for (const std::size_t i : std::exchange(falling, {})) p.fell[i] = true;
      sense(p);
      hand = player.step(p);
      hand.z() = std::max(hand.z(), kHand_m);
      force.setZero();
      for (std::size_t i = 0; i < balls.size(); ++i) push(i);
      if (in_holes() == balls.size() && player.action() == Player::Action::kDone) return true;
    }
    return false;
  }
  void push(std::size_t i) {
    const Goal& goal = rules.goals[i];
    if (balls[i].z() < 0) return;
    const Vector3d d = balls[i] - hand;
    const double deep = goal.ball_radius_m + kHand_m - d.norm();
    if (deep > 0) {
      Vector3d away(d.x(), d.y(), 0);
      away.normalize();
      balls[i] += deep * away;
      force = -0.5 * away;
    }
    if ((Vector3d(balls[i].x(), balls[i].y(), 0) - goal.hole_m).norm() < goal.hole_radius_m / 2) balls[i].z() = -0.07, falling.push_back(i);
  }
  std::size_t in_holes() const {
    return static_cast<std::size_t>(std::count_if(balls.begin(), balls.end(), [](const Vector3d& b) { return b.z() < 0; }));
  }

  Rules rules;
  std::vector<Vector3d> balls;
  Player player;
  Vector3d hand{-0.2, 0, 0.13}, force{0, 0, 0};
  std::vector<std::size_t> falling;
  double time_s = 100;
};

}  // namespace

TEST_CASE("A player with sight pushes a ball into its hole from any start position") {
  for (const double x : {-0.2, -0.05, 0.05, 0.3})
    for (const double y : {-0.15, 0.0, 0.1}) {
      ToyWorld toy(one_ball(), {{x, y, 0.025}});
      INFO("ball at " << x << " " << y);
      CHECK(toy.play(15));
    }
}

TEST_CASE("A player pushes one ball after the other, each into its own hole") {
  ToyWorld toy(two_balls(), {{-0.05, 0.05, 0.025}, {-0.08, 0.25, 0.03}});
  CHECK(toy.play(20));
}

TEST_CASE("A player does not react before the reaction time has passed") {
  ToyWorld toy(one_ball(), {{0, 0, 0.025}});
  const Vector3d rest = toy.hand;
  // Before the reaction time has passed no percept takes effect: the player moves towards its first guess of the ball, beside the hole.
  toy.play(0.14);
  const Vector3d before = toy.hand;
  toy.play(0.1);
  CHECK((before - rest).norm() < 0.14 * PlayerDef{}.air_speed_m_s + 1e-9);
}

TEST_CASE("The hand keeps its speed limit for any percepts") {
  ToyWorld toy(two_balls(), {{-0.05, 0.05, 0.025}, {-0.08, 0.25, 0.03}});
  Vector3d last = toy.hand;
  double fastest = 0;
  toy.play(20, [&](Percept& p) {
    fastest = std::max(fastest, (p.hand_m - last).norm() / kPlayerStep_s);
    last = p.hand_m;
    if (static_cast<int>(p.time_s * 10) % 3 == 0) p.balls_m[0] = Vector3d(0.3, -0.3, 0.025);  // the ball seems to jump
  });
  CHECK(fastest <= 1.001 * std::max(PlayerDef{}.air_speed_m_s, 6 * 0.2));
}

TEST_CASE("A player who hears a ball fall starts on the next ball at once, and a deaf player waits to see it") {
  const auto until_next = [](bool hears, bool sees_at_once) {
    ToyWorld toy(two_balls(), {{-0.05, 0, 0.025}, {-0.08, 0.3, 0.03}});
    double fell_s = 0, next_s = 0;
    std::vector<std::pair<double, std::vector<std::optional<Vector3d>>>> shown;
    toy.play(20, [&](Percept& p) {
      if (fell_s == 0 && toy.in_holes() > 0) fell_s = p.time_s;
      if (fell_s > 0 && next_s == 0 && toy.player.goal() == 1) next_s = p.time_s;
      if (!hears) p.fell.assign(p.fell.size(), false);
      shown.emplace_back(p.time_s, p.balls_m);
      if (!sees_at_once && shown.size() > 500) p.balls_m = shown[shown.size() - 500].second;  // half a second late
    });
    REQUIRE(next_s > 0);
    return next_s - fell_s;
  };
  CHECK(until_next(true, false) == Approx(PlayerDef{}.reaction_s).margin(0.01));
  CHECK(until_next(false, true) == Approx(PlayerDef{}.reaction_s).margin(0.01));
  CHECK(until_next(false, false) == Approx(PlayerDef{}.reaction_s + 0.5).margin(0.02));
}

TEST_CASE("A blind player finds a ball by touch near its announced place") {
  ToyWorld toy(one_ball(), {{-0.05, 0.04, 0.025}});
  const auto blind = [](Percept& p) { p.balls_m.assign(p.balls_m.size(), std::nullopt); };
  toy.play(40, blind);
  CHECK((toy.balls[0] - Vector3d(-0.05, 0.04, 0.025)).norm() > 0.01);  // the hand touched and moved it

  ToyWorld numb(one_ball(), {{-0.05, 0.04, 0.025}});
  numb.play(40, [&](Percept& p) {
    blind(p);
    p.force_N.setZero();
    p.fell.assign(1, false);
  });
  CHECK(numb.player.goal() == 0);  // no percept reported a reached goal
}
