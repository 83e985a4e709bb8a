#include "haptic_node/safety/pending_energy.h"

#include <algorithm>
#include <cmath>

namespace tactus::haptic {
namespace {

// Minimum duration of one entry of the history: a tick at 1 kHz, less rounding.
constexpr double kPush_s = 0.00099;
// Time constant of the holding-force estimate: it does not average several models at 30 Hz, and does not follow
// the noise of one step.
constexpr double kHoldingFilter_s = 0.02;
// Time for which the holding force is assumed to persist; after it the body counts as free. Longer than a period
// of 30 Hz, shorter than the 50 ms after which a touch model is lost.
constexpr double kHoldingTime_s = 0.04;

}  // namespace

void PendingEnergyEstimator::on_report(const BodyReport& report, double max_force_N) {
  if (report_.sim_ns >= 0 && report.sim_ns > report_.sim_ns) {
    // Newton: the change of momentum minus the push is the impulse of other bodies.
    const double dt = 1e-9 * static_cast<double>(report.sim_ns - report_.sim_ns);
    const double others_N_s = report.normal.dot(report.mass_kg * (report.velocity - report_.velocity) -
                                                (report.impulse_N_s - report_.impulse_N_s));
    holding_N_ += (1 - std::exp(-dt / kHoldingFilter_s)) *
                  (std::clamp(others_N_s / dt, -max_force_N, max_force_N) - holding_N_);
  }
  report_ = report;
  fresh_ = true;
}

void PendingEnergyEstimator::on_report(const Eigen::Vector3d& impulse_N_s) {
  report_.impulse_N_s = impulse_N_s;
  fresh_ = true;
}

void PendingEnergyEstimator::reset(const Eigen::Vector3d& impulse_N_s) {
  total_impulse_N_s_ = report_.impulse_N_s = impulse_N_s;
  count_ = 0;
  work_J_ = 0;
}

void PendingEnergyEstimator::add_push(const Eigen::Vector3d& force_N, double dt) {
  total_impulse_N_s_ += dt * force_N;
  const double push_N = std::max(0.0, -force_N.dot(report_.normal));
  if (count_ == 0 || pushes_[newest_].dt >= kPush_s) {
    newest_ = (newest_ + 1) % pushes_.size();
    count_ = std::min(count_ + 1, pushes_.size());
    pushes_[newest_] = {};
  }
  pushes_[newest_].impulse_N_s += push_N * dt;
  pushes_[newest_].dt += dt;
  if (report_.sim_ns >= 0) advance(push_N, dt);
}

void PendingEnergyEstimator::advance(double push_N, double dt) {
  const bool trusted = since_report_s_ < kHoldingTime_s;
  double holding_N = trusted ? holding_N_ : std::min(holding_N_, 0.0);
  since_report_s_ += dt;
  if (trusted && since_report_s_ >= kHoldingTime_s) speed_m_s_ += swing_back_m_s();
  if (speed_m_s_ < 0) holding_N = std::min(holding_N, 0.0);
  double next = speed_m_s_ + (push_N - holding_N) / report_.mass_kg * dt;
  if (speed_m_s_ >= 0) next = std::max(0.0, next);
  work_J_ += push_N * dt * 0.5 * (speed_m_s_ + next);
  speed_m_s_ = next;
}

// A body that moved towards the hand may have swung back. Returns the speed that this adds along the push.
double PendingEnergyEstimator::swing_back_m_s() const {
  return 2 * std::max(0.0, report_.normal.dot(report_.velocity));
}

// Replays the newest pushes, at most those of the last window_s, until they add up to the unreported impulse. An
// older push gave the missing part.
void PendingEnergyEstimator::replay(double window_s, double pending_N_s) {
  const auto push = [&](std::size_t back) { return pushes_[(newest_ + pushes_.size() - back) % pushes_.size()]; };
  std::size_t first = 0;
  // share of the oldest replayed push, which may be partly reported
  double time_s = 0, remaining_N_s = pending_N_s, share = 1;
  while (first < count_ && time_s < window_s && share == 1) {
    const Push p = push(first++);
    if (p.impulse_N_s > remaining_N_s) share = remaining_N_s / p.impulse_N_s;
    time_s += share * p.dt;
    remaining_N_s = share < 1 ? 0 : remaining_N_s - p.impulse_N_s;
  }
  since_report_s_ = std::max(0.0, window_s - time_s);
  speed_m_s_ = -report_.normal.dot(report_.velocity);
  if (since_report_s_ >= kHoldingTime_s) speed_m_s_ += swing_back_m_s();
  work_J_ = remaining_N_s * (speed_m_s_ + 0.5 * remaining_N_s / report_.mass_kg);
  speed_m_s_ += remaining_N_s / report_.mass_kg;
  for (std::size_t back = first; back-- > 0;) {
    const Push p = push(back);
    if (p.dt > 0) advance(p.impulse_N_s / p.dt, (back + 1 == first ? share : 1) * p.dt);
  }
}

double PendingEnergyEstimator::energy_J(double window_s, double max_force_N) {
  if (report_.sim_ns < 0) return 0;
  Eigen::Vector3d pending_N_s = total_impulse_N_s_ - report_.impulse_N_s;
  const double size = pending_N_s.norm(), max_impulse_N_s = max_force_N * window_s;
  if (size > max_impulse_N_s) pending_N_s *= max_impulse_N_s / size;  // a part was never applied
  const double along_normal = pending_N_s.dot(report_.normal);
  if (fresh_) replay(window_s, std::max(0.0, -along_normal));
  fresh_ = false;
  return work_J_ + (pending_N_s - along_normal * report_.normal).dot(report_.velocity);
}

}  // namespace tactus::haptic
