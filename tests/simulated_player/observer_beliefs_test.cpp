// The beliefs of the observer player about hand and ball, from pictures of both.
#include "scripts/simulated_player/observer_beliefs.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scripts/simulated_player/observer/vision.h"

using namespace tactus;
using namespace tactus::simulated_player;
using Eigen::Vector3d;

namespace {

Rules belief_rules() {
  return {.goals = {{.body = 4, .hole_m = {0.15, -0.3, 0}, .hole_radius_m = 0.03, .ball_radius_m = 0.025}}, .hand_radius_m = 0.008, .floor_m = {}, .slope_m_s2 = {0, 0, 0}};
}

Viewer belief_viewer() {
  Viewer viewer;
  viewer.eye_m = {-1.2, 0, 0.92};
  const Vector3d forward = (Vector3d(0.04, 0, 0.09) - viewer.eye_m).normalized();
  viewer.axes.col(0) = Vector3d(0, -1, 0), viewer.axes.col(2) = forward, viewer.axes.col(1) = viewer.axes.col(0).cross(forward);
  return viewer;
}

// A picture of a ball and the hand, shown until the next one.
void show(ObserverSenses& senses, double now, double interval_s, const Vector3d& ball, const Vector3d& hand) {
  Picture picture;
  picture.shown_s = now, picture.interval_s = interval_s;
  picture.balls.emplace_back(Picture::Ball{ball, 400});
  picture.hand_m = hand;
  senses.show(picture, ball);
}

// The hand rests without a force.
void rest(ObserverSenses& senses, double now, const Vector3d& hand) {
  senses.press(now, Vector3d::Zero());
  senses.place_hand(now, hand);
}

// Errors of the beliefs of a typical person who looks at a resting hand beside a ball, root mean square over 2 s, m.
struct BeliefErrors {
  double between_m = 0, ball_m = 0;  // across the sight: ball minus hand, and the ball
};

BeliefErrors looked_at(std::uint64_t seed, double ball_speed_m_s = 0) {
  const Vector3d hand(-0.1, -0.3, 0.019);
  Vector3d ball(-0.04, -0.3, 0.025);
  ObserverSenses senses({}, belief_rules(), belief_viewer(), seed);
  ObserverBeliefs beliefs({}, belief_rules(), belief_viewer(), [](std::size_t, const Vector3d&) { return 400.0; }, hand, seed);
  BeliefErrors errors;
  int count = 0;
  for (int step = 0; step < 300; ++step) {
    const double now = step * kSampleStep_s;
    ball.y() += kSampleStep_s * ball_speed_m_s;
    if (step % 2 == 0) show(senses, now, 2 * kSampleStep_s, ball, hand);
    rest(senses, now, hand);
    beliefs.perceive(now, senses, 0, false);
    beliefs.predict(now, Vector3d::Zero(), 0);
    if (step < 100) continue;
    ++count;
    const Vector3d off = beliefs.ball(0).place_m() - ball, between = off - (beliefs.hand().place_m() - hand);
    errors.between_m += between.y() * between.y(), errors.ball_m += off.y() * off.y();
  }
  return {std::sqrt(errors.between_m / count), std::sqrt(errors.ball_m / count)};
}

}  // namespace

TEST_CASE("A person locates a ball beside the hand better than a look at the hand locates the hand") {
  BeliefErrors mean;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const BeliefErrors e = looked_at(seed);
    mean.between_m += e.between_m / 12, mean.ball_m += e.ball_m / 12;
  }
  // A look of 0.1 s at a ball 1.5 m away: the hand is 6 cm beside the gaze, where the noise of a direction is 5.5 mm.
  const double look_m = observer::seen_sd_m({}, 1.5, 0.06);
  CHECK(mean.ball_m < look_m);
  CHECK(mean.between_m < look_m);
}

TEST_CASE("An error of the felt place of the hand does not move a seen ball") {
  observer::PlayerParameters off;
  off.proprioceptive_bias_m = 0.1;
  const Vector3d hand(-0.1, -0.3, 0.019), ball(-0.04, -0.3, 0.025);
  double moved_m = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    ObserverSenses senses(off, belief_rules(), belief_viewer(), seed);
    ObserverBeliefs beliefs(off, belief_rules(), belief_viewer(), [](std::size_t, const Vector3d&) { return 400.0; }, hand, seed);
    for (int step = 0; step < 200; ++step) {
      const double now = step * kSampleStep_s;
      show(senses, now, kSampleStep_s, ball, hand);
      rest(senses, now, hand);
      beliefs.perceive(now, senses, 0, false);
      beliefs.predict(now, Vector3d::Zero(), 0);
    }
    moved_m = std::max(moved_m, (beliefs.ball(0).place_m() - ball).norm());
  }
  CHECK(moved_m < 0.015);
}

TEST_CASE("A filter with an unsure input of one step follows a measurement faster than one without") {
  observer::HandModel model;
  model.dt_s = 0.01;
  model.a = observer::Matrix::Identity(2, 2);
  model.a(0, 1) = 0.01;
  model.b = observer::Vector::Unit(2, 1) * 0.01;
  model.noise = observer::Matrix::Identity(2, 2) * 1e-12;
  const auto speed_after = [&](double input_sd) {
    observer::DelayedKalman filter(model, observer::Vector::Zero(2), observer::Matrix::Identity(2, 2) * 1e-6);
    filter.predict(0, input_sd);
    for (int i = 1; i <= 20; ++i) filter.measure(0, observer::Vector::Unit(2, 0), 0.002 * i, 1e-6), filter.predict(0);
    return filter.mean()[1];
  };
  CHECK(speed_after(30) > speed_after(0));
  CHECK(speed_after(30) == Approx(0.2).margin(0.03));
}
