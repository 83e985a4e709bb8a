#include "scripts/trial_runner/hand.h"

#include <cmath>
#include <numbers>

namespace tactus::trial_runner {
namespace {

constexpr double kApproach_s = 0.5;  // to the surface before a press, and back after it; design

// From 0 to 1, with zero speed at both ends.
double smooth(double share) { return 0.5 - 0.5 * std::cos(std::numbers::pi * share); }

}  // namespace

bool Hand::tap(const TapRequest& request) {
  if (busy()) return false;
  tap_ = request, elapsed_s_ = 0;
  return true;
}

bool Hand::press(const PressRequest& request) {
  if (busy()) return false;
  press_ = request, elapsed_s_ = 0;
  return true;
}

std::optional<double> Hand::depth_below_rest_m() const {
  if (tap_) {
    const double deepest = above_m_ + tap_->depth_m, down_s = deepest / kDown_m_s;
    if (elapsed_s_ < down_s) return elapsed_s_ * kDown_m_s;
    if (elapsed_s_ < down_s + kDwell_s) return deepest;
    if (elapsed_s_ < down_s + kDwell_s + kUp_s)
      return deepest * (1 - smooth((elapsed_s_ - down_s - kDwell_s) / kUp_s));
  }
  if (press_) {
    const double pressing_s = press_->period_s * press_->times;
    if (elapsed_s_ < kApproach_s) return above_m_ * smooth(elapsed_s_ / kApproach_s);
    if (const double t = elapsed_s_ - kApproach_s; t < pressing_s)
      return above_m_ + press_->depth_m * (0.5 - 0.5 * std::cos(2 * std::numbers::pi * t / press_->period_s));
    if (const double t = elapsed_s_ - kApproach_s - pressing_s; t < kApproach_s)
      return above_m_ * (1 - smooth(t / kApproach_s));
  }
  return std::nullopt;
}

void Hand::step(double dt_s) {
  if (!busy()) {
    velocity_m_s_.setZero();
    return;
  }
  elapsed_s_ += dt_s;
  const auto below = depth_below_rest_m();
  if (!below) tap_.reset(), press_.reset();
  const Eigen::Vector3d at = rest_m_ - Eigen::Vector3d(0, 0, below.value_or(0));
  velocity_m_s_ = (at - position_m_) / dt_s;
  position_m_ = at;
}

}  // namespace tactus::trial_runner
