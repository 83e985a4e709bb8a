#include "scripts/simulated_player/believed_hand.h"

#include "scripts/simulated_player/observer/hand.h"
#include "scripts/simulated_player/observer_senses.h"

namespace tactus::simulated_player {
namespace {

using Eigen::Vector3d;
using observer::kHandStates;

constexpr int kBiasState = kHandStates;      // the state after those of the hand
constexpr double kSurprisingPush_N = 0.5;    // unexpected forces of this size, each for 10 ms (design)

observer::HandModel model_of(const observer::PlayerParameters& player) {
  const observer::Hand hand(player, kSampleStep_s, 0);
  observer::HandModel model;
  model.dt_s = kSampleStep_s;
  model.a = observer::Matrix::Identity(kHandStates + 1, kHandStates + 1);
  model.a.topLeftCorner(kHandStates, kHandStates) = hand.plant().a;
  model.b = observer::Vector::Zero(kHandStates + 1);
  model.b.head(kHandStates) = hand.plant().b;
  model.noise = observer::Matrix::Identity(kHandStates + 1, kHandStates + 1) * 1e-14;
  const double push_m_s = kSurprisingPush_N * kSampleStep_s / player.mass_kg;
  model.noise(observer::kSpeed, observer::kSpeed) += push_m_s * push_m_s;
  model.control_share = hand.share();
  model.control_sd = hand.constant_N();
  model.speed_noise_m2_s = player.process_noise_m2_s;
  return model;
}

observer::Vector measures(bool with_bias) {
  observer::Vector h = observer::Vector::Zero(kHandStates + 1);
  h[observer::kPlace] = 1, h[kBiasState] = with_bias;
  return h;
}

}  // namespace

BelievedHand::BelievedHand(const observer::PlayerParameters& player, const Eigen::Matrix3d& axes, const Vector3d& start_m)
    : player_(player), axes_(axes) {
  const observer::HandModel model = model_of(player);
  observer::Matrix covariance = observer::Matrix::Identity(kHandStates + 1, kHandStates + 1) * 1e-10;
  const double bias_m2 = player.proprioceptive_bias_m * player.proprioceptive_bias_m / 3;
  covariance(observer::kPlace, observer::kPlace) = bias_m2;
  covariance(kBiasState, kBiasState) = bias_m2;
  const Vector3d start = axes.transpose() * start_m;
  for (int i = 0; i < 3; ++i) {
    observer::Vector mean = observer::Vector::Zero(kHandStates + 1);
    mean[observer::kPlace] = start[i];
    filters_.emplace_back(model, mean, covariance);
  }
}

void BelievedHand::predict(const Vector3d& command_N) {
  const Vector3d along = axes_.transpose() * command_N;
  for (std::size_t i = 0; i < 3; ++i) filters_[i].predict(along[static_cast<Eigen::Index>(i)]);
}

void BelievedHand::feel_place(double age_s, const Vector3d& hand_m, double sd_m) {
  static const observer::Vector h = measures(true);
  const Vector3d reference = axes_.transpose() * (hand_m - offset_m_);
  for (std::size_t i = 0; i < 3; ++i) filters_[i].measure(age_s, h, reference[static_cast<Eigen::Index>(i)], sd_m * sd_m);
}

void BelievedHand::see(double age_s, const Vector3d& hand_m, double sd_m, double depth_sd_m) {
  static const observer::Vector h = measures(false);
  const Vector3d reference = axes_.transpose() * (hand_m - offset_m_);
  for (std::size_t i = 0; i < 3; ++i) {
    const double sd = i == 2 ? depth_sd_m : sd_m;
    filters_[i].measure(age_s, h, reference[static_cast<Eigen::Index>(i)], sd * sd);
  }
}

void BelievedHand::see_across(double age_s, const Vector3d& hand_m, double sd_m) {
  static const observer::Vector h = measures(false);
  const Vector3d reference = axes_.transpose() * (hand_m - offset_m_);
  for (std::size_t i = 0; i < 2; ++i) filters_[i].measure(age_s, h, reference[static_cast<Eigen::Index>(i)], sd_m * sd_m);
}

void BelievedHand::feel_load(const Vector3d& force_N) {
  offset_m_ = force_N / (player_.stiffness_N_m + player_.stiffness_rise_1_m * force_N.norm());
}

Vector3d BelievedHand::place_m() { return place_before_m(0); }

Vector3d BelievedHand::place_before_m(double age_s) {
  Vector3d along;
  for (std::size_t i = 0; i < 3; ++i) along[static_cast<Eigen::Index>(i)] = filters_[i].mean_before(age_s)[observer::kPlace];
  return axes_ * along + offset_m_;
}

Vector3d BelievedHand::speed_m_s() {
  Vector3d along;
  for (std::size_t i = 0; i < 3; ++i) along[static_cast<Eigen::Index>(i)] = filters_[i].mean()[observer::kSpeed];
  return axes_ * along;
}

HandState BelievedHand::state_along(const Vector3d& direction, const Vector3d& origin_m) {
  const Vector3d share = axes_.transpose() * direction;
  HandState state = HandState::Zero();
  for (std::size_t i = 0; i < 3; ++i) state += share[static_cast<Eigen::Index>(i)] * filters_[i].mean().head(kHandStates);
  state[observer::kPlace] -= direction.dot(origin_m);
  return state;
}

double BelievedHand::variance_m2(const Vector3d& direction) {
  const Vector3d share = axes_.transpose() * direction;
  double variance = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double part = share[static_cast<Eigen::Index>(i)];
    variance += part * part * filters_[i].covariance()(observer::kPlace, observer::kPlace);
  }
  return variance;
}

}  // namespace tactus::simulated_player
