#include "haptic_node/rendering/transient.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::haptic {
namespace {

// Young's moduli between which the frequency is interpolated: rubber (0.01 GPa) and aluminium (70 GPa), Ashby
// 2011.
constexpr double kSoft_Pa = 1e7, kHard_Pa = 7e10;
// The ringing ends below this amplitude. One hundredth of a newton is below the threshold of fingers for a
// vibration of a held tool.
constexpr double kSilent_N = 0.01;
// Time in which the impulse of a transient is taken back: a corner of 3.2 Hz, below the 5 Hz of the slowest transient.
constexpr double kReturn_s = 0.05;
// Below this force the rest of the impulse is dropped: 5 uN s, a thousandth of a light tap.
constexpr double kReturned_N = 1e-4;

presentation_t report_of(const Hit& hit, std::int64_t presented_ns, sync::Nanoseconds uncertainty,
                         std::int8_t outcome) {
  presentation_t r{};
  r.event_id = hit.event_id;
  r.part = presentation_t::TRANSIENT;
  r.scheduled_ns = sync::to_ns(hit.scheduled);
  r.presented_ns = presented_ns;
  r.uncertainty_ns = uncertainty.count();
  r.outcome = outcome;
  return r;
}

}  // namespace

double transient_frequency_Hz(double youngs_modulus_Pa, const TransientShape& shape) {
  if (youngs_modulus_Pa <= 0) return shape.hard_frequency_Hz;
  const double s = std::clamp(std::log(youngs_modulus_Pa / kSoft_Pa) / std::log(kHard_Pa / kSoft_Pa), 0.0, 1.0);
  return shape.soft_frequency_Hz * std::pow(shape.hard_frequency_Hz / shape.soft_frequency_Hz, s);
}

double transient_amplitude_N(const Hit& hit, const TransientShape& shape) {
  const double momentum = hit.effective_mass_kg * hit.approach_speed_m_s;
  const double frequency = transient_frequency_Hz(hit.youngs_modulus_Pa, shape);
  return std::min(shape.limit_N, shape.gain * std::numbers::pi * frequency * momentum);
}

void Transients::schedule(const Hit& hit, std::vector<presentation_t>& reports) {
  if (pending_.size() < kMaxPending)
    pending_.push_back(hit);
  else
    reports.push_back(report_of(hit, -1, sync::Nanoseconds(0), presentation_t::DROPPED_LATE));
}

void Transients::stop() {
  active_.clear();
  felt_N_s_.setZero();
}

void Transients::begin(const Hit& hit, sync::HostTime now) {
  if (active_.size() >= kMaxActive) active_.erase(active_.begin());  // the oldest has decayed most
  active_.push_back({hit.direction, transient_amplitude_N(hit, shape_),
                     transient_frequency_Hz(hit.youngs_modulus_Pa, shape_), now});
}

Eigen::Vector3d Transients::step(sync::HostTime now, double dt, bool felt, sync::Nanoseconds uncertainty,
                                 std::vector<presentation_t>& reports) {
  std::erase_if(pending_, [&](const Hit& hit) {
    if (hit.scheduled > now) return false;
    const std::int8_t outcome = shape_.late.outcome(now - hit.scheduled);
    if (!felt || outcome == presentation_t::DROPPED_LATE) {
      reports.push_back(report_of(hit, -1, uncertainty, presentation_t::DROPPED_LATE));
      return true;
    }
    begin(hit, now);
    reports.push_back(report_of(hit, sync::to_ns(now), uncertainty, outcome));
    return true;
  });
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  std::erase_if(active_, [&](const ActiveTransient& r) {
    const double t = sync::to_seconds(now - r.start) + dt / 2;
    const double envelope = r.amplitude_N * std::exp(-shape_.decay_1_s * t);
    if (envelope < kSilent_N) return true;
    force += envelope * std::sin(2 * std::numbers::pi * r.frequency_Hz * t) * r.direction;
    return false;
  });
  if (!felt || (active_.empty() && felt_N_s_.norm() < kReturned_N * kReturn_s)) felt_N_s_.setZero();
  force -= felt_N_s_ / kReturn_s;
  const double size = force.norm();
  return size > shape_.limit_N ? Eigen::Vector3d(force * (shape_.limit_N / size)) : force;
}

}  // namespace tactus::haptic
