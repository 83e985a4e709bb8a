#include "scripts/experiments/object_control.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scripts/simulated_player/observer/vision.h"

namespace tactus::experiments {
namespace {

using observer::kHandStates;
using observer::kPlace;
using observer::kSpeed;
using observer::Matrix;
using observer::Vector;

constexpr int kGap = kHandStates;
// The standard deviations of the population hold for a look of this duration (as in observer/pointing.cpp).
constexpr double kControlLook_s = 0.1, kPicture_s = 0.015, kBodySample_s = 0.010;
constexpr double kEyeDistance_m = 0.6;
constexpr double kExpectedForce_N = 1;  // pushes of the object that change every 10 ms (as in responses.cpp)

observer::HandModel coupled_model(const observer::PlayerParameters& player, double gap_m2_s) {
  const observer::Hand hand(player, kControlStep_s, 0);
  observer::HandModel model;
  model.dt_s = kControlStep_s;
  model.a = Matrix::Identity(kHandStates + 1, kHandStates + 1);
  model.a.topLeftCorner(kHandStates, kHandStates) = hand.plant().a;
  model.b = Vector::Zero(kHandStates + 1);
  model.b.head(kHandStates) = hand.plant().b;
  model.noise = Matrix::Identity(kHandStates + 1, kHandStates + 1) * 1e-14;
  model.noise(kGap, kGap) = gap_m2_s * kControlStep_s;
  const double push_m_s = kExpectedForce_N * kControlStep_s / player.mass_kg * std::sqrt(0.01 / kControlStep_s);
  model.noise(kSpeed, kSpeed) = push_m_s * push_m_s;
  model.control_share = hand.share();
  model.control_sd = hand.constant_N();
  model.speed_noise_m2_s = player.process_noise_m2_s;
  return model;
}

Vector start_state(double start_m) {
  Vector state = Vector::Zero(kHandStates + 1);
  state[kPlace] = start_m;
  return state;
}

}  // namespace

Vector paced_feedback(const observer::PlayerParameters& player) {
  return observer::approach_feedback(player, std::numbers::ln2 / player.pace_s_bit, kControlStep_s);
}

ObjectControl::ObjectControl(const observer::PlayerParameters& player, const Vector& feedback, double start_m,
                             double gap_m2_s, std::uint64_t seed)
    : player_(player),
      feedback_(feedback),
      noise_(seed, 1),
      eyes_(player.visual_latency_s),
      body_(player.touch_latency_s),
      skin_(player.touch_latency_s),
      estimate_(coupled_model(player, gap_m2_s), start_state(start_m),
                Matrix::Identity(kHandStates + 1, kHandStates + 1) * 1e-6),
      bias_m_(noise_.uniform() < 0.5 ? -player.proprioceptive_bias_m : player.proprioceptive_bias_m) {}

void ObjectControl::see(double presented_s, double object_m) {
  const double sd =
      observer::seen_gap_sd_m(player_, kEyeDistance_m, object_m) * std::sqrt(kControlLook_s / kPicture_s);
  const double off = noise_.normal(sd);
  if (noise_.uniform() >= player_.lapse) eyes_.present(presented_s, Eigen::Vector3d(object_m + off, 0, 0), sd);
}

void ObjectControl::sense_hand(double at_s, double hand_m) {
  const double sd = player_.proprioceptive_sd_m * std::sqrt(kControlLook_s / kBodySample_s);
  // The gap absorbs the constant bias of the sensed place, because sight shows the object itself.
  body_.present(at_s, Eigen::Vector3d(hand_m + bias_m_ + noise_.normal(sd), 0, 0), sd);
}

void ObjectControl::feel(double at_s, double force_N, double stiffness_N_m) {
  const double sd_N =
      observer::weber_sd(player_.force_weber) * std::abs(force_N) * std::sqrt(kControlLook_s / kBodySample_s);
  const double off_N = noise_.normal(sd_N);
  if (std::abs(force_N) < player_.force_floor_N) return;
  skin_.present(at_s, Eigen::Vector3d((force_N + off_N) / stiffness_N_m, 0, 0), sd_N / stiffness_N_m);
}

double ObjectControl::command(double now_s) {
  Vector object = Vector::Zero(kHandStates + 1), hand = object, gap = object;
  object[kPlace] = object[kGap] = hand[kPlace] = gap[kGap] = 1;
  while (const auto p = body_.take(now_s))
    estimate_.measure(player_.touch_latency_s, hand, p->value.x(), p->sd * p->sd);
  while (const auto p = skin_.take(now_s))
    estimate_.measure(player_.touch_latency_s, gap, p->value.x(), p->sd * p->sd);
  const double believed_s = std::max(0.0, player_.visual_latency_s + player_.initial_delay_error_s);
  while (const auto p = eyes_.take(now_s)) estimate_.measure(believed_s, object, p->value.x(), p->sd * p->sd);
  const Vector& x = estimate_.mean();
  Vector goal = x.head(kHandStates);
  goal[kPlace] += x[kGap];
  const double u = -feedback_.dot(goal);
  estimate_.predict(u);
  return u;
}

}  // namespace tactus::experiments
