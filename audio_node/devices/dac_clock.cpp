#include "audio_node/devices/dac_clock.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {
namespace {

constexpr double kWindow_s = 10;       // 200 ppm of drift are at most 2 ms in it; design
constexpr double kBandwidth_Hz = 0.5;  // slow against the jitter of the calls, fast against the drift of a quartz
constexpr double kOutlier_s = 0.001;   // a thread that was suspended between the two readings of PortAudio
constexpr int kOutliersToReseed = 8;
constexpr double kForgetting = 0.01;  // of the residual, per block
constexpr double kMaxLatency_s = 1;
// PortAudio reads its clock shortly before the callback; that time is in the calibration. At most 20 us on a
// machine that is not stalled.
constexpr double kCalibration_s = 20e-6;

}  // namespace

double DacClock::offset_s(const CallbackTime& t) {
  const double now = sync::to_seconds(t.now - base_), offset = now - t.current_s;
  const double best = std::min(minimum_s_, older_minimum_s_);
  const bool jumped = calibrated_ && std::abs(offset - best) > kMaxLatency_s;
  // A callback may be late, but a run of late ones means that the clock of PortAudio stepped back, which no
  // minimum detects.
  late_minimum_s_ = late_ > 0 ? std::min(late_minimum_s_, offset) : offset;
  late_ = offset - best > kOutlier_s ? late_ + 1 : 0;
  const bool stepped_back = late_ >= kOutliersToReseed;
  if (!calibrated_ || jumped || stepped_back) {
    minimum_s_ = older_minimum_s_ = stepped_back && !jumped ? late_minimum_s_ : offset;
    late_ = 0;
    window_end_s_ = now + kWindow_s;
    calibrated_ = true;
  }
  if (now > window_end_s_) {
    older_minimum_s_ = minimum_s_;
    minimum_s_ = offset;
    window_end_s_ = now + kWindow_s;
  }
  minimum_s_ = std::min(minimum_s_, offset);
  return std::min(minimum_s_, older_minimum_s_);
}

void DacClock::seed(double raw_s) {
  next_s_ = raw_s;
  blocks_ = 0;
  outliers_ = 0;
  ++reseeds_;
}

DacClock::Estimate DacClock::block(int frames, const CallbackTime& t, double latency_s) {
  if (!based_) base_ = t.now, based_ = true;
  const double lead = t.dac_s - t.current_s;
  const bool plausible = t.current_s != 0 && lead > 0 && lead < kMaxLatency_s;
  const double raw = plausible ? t.dac_s + offset_s(t) : sync::to_seconds(t.now - base_) + latency_s;

  if (reseeds_ == 0 || t.underflow) seed(raw);
  double error = raw - next_s_;
  outliers_ = std::abs(error) > kOutlier_s ? outliers_ + 1 : 0;
  if (outliers_ >= kOutliersToReseed) {
    seed(raw);
    error = 0;
  }
  // A single bad reading has no effect.
  const double accepted = std::abs(error) > kOutlier_s ? 0 : error;
  // At first a plain mean, which settles fastest; then the loop.
  const double dt = frames / rate_Hz_, w = 2 * std::numbers::pi * kBandwidth_Hz * dt;
  const double b = std::max(std::numbers::sqrt2 * w, 1.0 / static_cast<double>(blocks_ + 1));
  const bool settled = static_cast<double>(blocks_) * dt > 1;
  const double time = next_s_ + b * accepted;
  if (settled) period_ = std::clamp(period_ + w * w * accepted / dt, 1 - 1e-3, 1 + 1e-3);
  next_s_ = time + dt * period_;
  square_s2_ += kForgetting * (accepted * accepted - square_s2_);
  ++blocks_;

  // An error that is not accepted yet may be real.
  const double unaccepted = outliers_ > 0 ? std::abs(error) : 0;
  const double uncertainty = 3 * std::sqrt(square_s2_) + kCalibration_s + unaccepted + (plausible ? 0 : latency_s);
  return {base_ + sync::from_seconds(time), sync::from_seconds(uncertainty)};
}

}  // namespace tactus::audio
