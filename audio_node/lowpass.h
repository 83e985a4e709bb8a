// A second-order Butterworth low-pass whose cut-off may change with every sample. Pure.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {

// |H|^2 = 1 / (1 + (f / cut-off)^4), by the bilinear transform with the cut-off in its place, as a state-variable
// filter with trapezoidal integrators, which is stable while it is modulated (Zavalishin, The Art of VA Filter
// Design, 2.1.0, 2018, section 4.4).
class Lowpass {
 public:
  // Nothing above 0.45 of the rate: that is as good as open.
  void set(double cutoff_Hz, double rate_Hz) {
    const double f = std::clamp(cutoff_Hz / rate_Hz, 0.0, 0.45);
    g_ = static_cast<float>(std::tan(std::numbers::pi * f));
    a_ = 1 / (1 + g_ * (g_ + std::numbers::sqrt2_v<float>));
  }
  float next(float in) {
    const float high = in - second_, v1 = a_ * (first_ + g_ * high), v2 = second_ + g_ * v1;
    first_ = 2 * v1 - first_, second_ = 2 * v2 - second_;
    return v2;
  }

 private:
  float g_ = 0, a_ = 1, first_ = 0, second_ = 0;
};

}  // namespace tactus::audio
