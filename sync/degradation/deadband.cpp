#include "sync/degradation/deadband.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::sync {

void Prediction::add(SimTime t, const Eigen::Vector3d& value) {
  slope_1_s_.setZero();
  reach_s_ = 0;
  if (const double dt_s = time_ ? to_seconds(t - *time_) : 0; predictor_ == Predictor::kLinear && dt_s > 0) {
    slope_1_s_ = (value - value_) / dt_s;
    reach_s_ = std::min(kReach * dt_s, kMaxReach_s);
  }
  time_ = t;
  value_ = value;
}

Eigen::Vector3d Prediction::at(SimTime t) const {
  return time_ ? Eigen::Vector3d(value_ + std::clamp(to_seconds(t - *time_), 0.0, reach_s_) * slope_1_s_) : value_;
}

Eigen::Vector3d Prediction::integral(SimTime t) const {
  if (!time_) return Eigen::Vector3d::Zero();
  const double dt_s = std::max(0.0, to_seconds(t - *time_)), line_s = std::min(dt_s, reach_s_);
  return dt_s * value_ + line_s * (dt_s - line_s / 2) * slope_1_s_;
}

bool Deadband::send(SimTime t, std::span<const Signal> signals, double speed_m_s) {
  const double dt_s = started_ ? std::max(0.0, to_seconds(t - last_)) : 0;
  const double filter_gain = def_.lowpass_Hz > 0 ? 1 - std::exp(-2 * std::numbers::pi * def_.lowpass_Hz * dt_s) : 1;
  const double fraction = def_.fraction + def_.adaptive_s_m * speed_m_s;
  bool changed = !started_ || (def_.resend_s > 0 && to_seconds(t - last_sent_) >= def_.resend_s * (1 - 1e-9));
  started_ = true;
  last_ = t;
  for (auto& [id, m] : memory_) m.present = false;
  for (const Signal& s : signals) {
    if (s.quantity != def_.quantity) continue;
    const auto [it, fresh] = memory_.try_emplace(s.id, Memory{s.value, Prediction(def_.predictor), true});
    Memory& m = it->second;
    m.present = true;
    if (!fresh) m.filtered += filter_gain * (s.value - m.filtered);
    const Eigen::Vector3d received = m.received.at(t);
    changed |= fresh || (m.filtered - received).norm() > std::max(fraction * received.norm(), def_.floor);
  }
  changed |= std::erase_if(memory_, [](const auto& entry) { return !entry.second.present; }) > 0;
  if (!changed) return false;
  last_sent_ = t;
  for (auto& [id, m] : memory_) m.received.add(t, m.filtered);
  return true;
}

}  // namespace tactus::sync
