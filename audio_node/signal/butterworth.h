// Second-order Butterworth low-pass and high-pass whose cutoff may change with every sample. Pure.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {

// low|^2 = 1 / (1 + (f / cutoff)^4) and |high|^2 = 1 - |low|^2, by the bilinear transform with a prewarped cutoff,
// as a state-variable filter with trapezoidal integrators, which is stable under modulation (Zavalishin, The Art
// of VA Filter Design, 2.1.0, 2018, section 4.4).
class Butterworth {
 public:
  struct Out {
    float low, high;
  };
  // Clamped to 0.45 of the rate, which is almost open.
  void set(double cutoff_Hz, double rate_Hz) {
    const double f = std::clamp(cutoff_Hz / rate_Hz, 0.0, 0.45);
    g_ = static_cast<float>(std::tan(std::numbers::pi * f));
    a_ = 1 / (1 + g_ * (g_ + kDamping));
  }
  Out next(float in) {
    const float high = a_ * (in - (kDamping + g_) * first_ - second_);
    const float band = g_ * high + first_, low = g_ * band + second_;
    first_ = g_ * high + band, second_ = g_ * band + low;
    return {low, high};
  }

 private:
  static constexpr float kDamping = std::numbers::sqrt2_v<float>;
  float g_ = 0, a_ = 1, first_ = 0, second_ = 0;
};

}  // namespace tactus::audio
