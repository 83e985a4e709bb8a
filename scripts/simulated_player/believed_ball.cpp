#include "scripts/simulated_player/believed_ball.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sync/random/keyed_random.h"

namespace tactus::simulated_player {
namespace {

using Eigen::Vector3d;

// Assumptions of the player about a ball. Design: accelerations that it does not expect, each for 10 ms; the share of an expected
// one that is unsure; and the time in which rolling fades.
constexpr double kSurprise_m_s2 = 0.5, kUnsureShare = 0.5, kRolls_s = 1.5;
constexpr double kHiddenDepth_m = 0.08;   // a ball in a hole is seen down to this depth below the floor (design)
constexpr double kFallShare = 0.3;        // a ball over its hole falls within three pictures (design)
constexpr double kReturns = 1e-3;         // a fallen ball lies on the floor again, for each picture (design)
constexpr double kLeast = 1e-4;

double density(double off, double variance) { return std::exp(-0.5 * off * off / variance) / std::sqrt(2 * std::numbers::pi * variance); }

}  // namespace

BelievedBall::BelievedBall(const Goal& goal, const Viewer& viewer, const Vector3d& guess_m, double sd_m) : goal_(goal) {
  const SightLine line = viewer.line_to(goal.hole_m);
  away_ = line.away;
  cotangent_ = line.cosine / std::max(line.sine, 0.1);
  axes_[0] = line.away, axes_[1] = line.right;
  observer::HandModel model;
  model.dt_s = kSampleStep_s;
  model.a = observer::Matrix::Identity(2, 2);
  model.a(0, 1) = kSampleStep_s;
  model.a(1, 1) = 1 - kSampleStep_s / kRolls_s;
  model.b = observer::Vector::Zero(2);
  model.b[1] = kSampleStep_s;
  model.noise = observer::Matrix::Identity(2, 2) * 1e-12;
  model.control_share = kUnsureShare, model.control_sd = kSurprise_m_s2;
  observer::Matrix covariance = observer::Matrix::Identity(2, 2) * 1e-4;
  covariance(0, 0) = sd_m * sd_m;
  for (const Vector3d& axis : axes_) {
    observer::Vector mean = observer::Vector::Zero(2);
    mean[0] = axis.dot(guess_m);
    filters_.emplace_back(model, mean, covariance, 1.0);
  }
}

void BelievedBall::predict(const Vector3d& acceleration_m_s2, const Vector3d& push_m_s2) {
  for (std::size_t i = 0; i < 2; ++i) filters_[i].predict(axes_[i].dot(acceleration_m_s2), axes_[i].cwiseProduct(push_m_s2).norm());
}

double BelievedBall::at_hole_probability(double age_s) {
  const double away = filters_[0].mean_before(age_s)[0] - axes_[0].dot(goal_.hole_m), across = filters_[1].mean_before(age_s)[0] - axes_[1].dot(goal_.hole_m);
  const double sd = std::sqrt((filters_[0].covariance()(0, 0) + filters_[1].covariance()(0, 0)) / 2);
  return sync::normal_cdf((goal_.hole_radius_m - std::hypot(away, across)) / std::max(sd, 1e-4));
}

void BelievedBall::see(double age_s, const Vector3d& at_m, const Vector3d& away, double away_sd_m, double across_sd_m) {
  static const observer::Vector place = observer::Vector::Unit(2, 0);
  in_hole_ += (1 - in_hole_) * kFallShare * at_hole_probability(age_s) - in_hole_ * kReturns;
  double on_floor = 1, fallen = 1, variance[2];
  for (std::size_t i = 0; i < 2; ++i) {
    variance[i] = variance_m2(i, away, away_sd_m, across_sd_m);
    on_floor *= density(axes_[i].dot(at_m) - filters_[i].mean_before(age_s)[0], variance[i] + filters_[i].covariance()(0, 0));
  }
  // Seen deeper, it seems nearer on the floor.
  const double depth_m = kHiddenDepth_m * cotangent_, play_m2 = goal_.hole_radius_m * goal_.hole_radius_m / 4;
  const Vector3d from_hole = at_m - goal_.hole_m;
  fallen *= density(from_hole.dot(away_) + depth_m / 2, variance[0] + play_m2 + depth_m * depth_m / 12);
  fallen *= density(from_hole.dot(axes_[1]), variance[1] + play_m2);
  const double evidence = fallen * in_hole_, other = on_floor * (1 - in_hole_);
  in_hole_ = std::clamp(evidence / std::max(evidence + other, 1e-300), kLeast, 1 - kLeast);
  if (in_hole_ > 0.5) return;
  for (std::size_t i = 0; i < 2; ++i) filters_[i].measure(age_s, place, axes_[i].dot(at_m), variance[i]);
}

void BelievedBall::miss(double age_s, double noticed_share) {
  const double fell = in_hole_ + (1 - in_hole_) * kFallShare * at_hole_probability(age_s);
  const double other = (1 - fell) * (1 - noticed_share);
  in_hole_ = std::clamp(fell / std::max(fell + other, 1e-300), kLeast, 1 - kLeast);
}

double BelievedBall::variance_m2(std::size_t i, const Vector3d& away, double away_sd_m, double across_sd_m) const {
  const double along = axes_[i].dot(away);
  return along * along * away_sd_m * away_sd_m + (1 - along * along) * across_sd_m * across_sd_m;
}

void BelievedBall::locate(double age_s, const Vector3d& at_m, const Vector3d& away, double away_sd_m, double across_sd_m) {
  static const observer::Vector place = observer::Vector::Unit(2, 0);
  for (std::size_t i = 0; i < 2; ++i) filters_[i].measure(age_s, place, axes_[i].dot(at_m), variance_m2(i, away, away_sd_m, across_sd_m));
}

void BelievedBall::hear_fall(double probability) { in_hole_ = std::clamp(in_hole_ + (1 - in_hole_) * probability, kLeast, 1 - kLeast); }

Vector3d BelievedBall::place_m() { return place_before_m(0); }

Vector3d BelievedBall::place_before_m(double age_s) {
  Vector3d at = axes_[0] * filters_[0].mean_before(age_s)[0] + axes_[1] * filters_[1].mean_before(age_s)[0];
  at.z() = goal_.hole_m.z() + goal_.ball_radius_m;
  return at;
}

Vector3d BelievedBall::speed_m_s() { return axes_[0] * filters_[0].mean()[1] + axes_[1] * filters_[1].mean()[1]; }

double BelievedBall::sd_m() { return std::sqrt(std::max(filters_[0].covariance()(0, 0), filters_[1].covariance()(0, 0))); }

}  // namespace tactus::simulated_player
