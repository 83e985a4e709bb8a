// The measured ears that libmysofa installs, and the output of our own rendering.
#pragma once

#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <vector>

#include "audio_node/spatial/sofa.h"
#include "audio_node/spatial/spatialiser.h"

namespace tactus::audio::test {

inline constexpr const char* kKemar = "/usr/share/libmysofa/MIT_KEMAR_normal_pinna.sofa";

inline const MeasuredHrtf& kemar() {
  static const MeasuredHrtf measured = load_sofa(kKemar);
  return measured;
}

inline std::shared_ptr<const Hrtf> ears(double rate_Hz = 48000) {
  return std::make_shared<const Hrtf>(kemar(), rate_Hz);
}

inline Eigen::Vector3f towards(double azimuth_deg, double elevation_deg = 0) {
  const double a = azimuth_deg * std::numbers::pi / 180, e = elevation_deg * std::numbers::pi / 180;
  return Eigen::Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)).cast<float>();
}

struct BinauralResponse {
  std::vector<double> left, right;
};

inline BinauralResponse measured_response(double azimuth_deg) {
  const MeasuredHrtf& m = kemar();
  std::size_t best = 0;
  for (std::size_t i = 0; i < m.directions.size(); ++i)
    if (m.directions[i].dot(towards(azimuth_deg).cast<double>()) >
        m.directions[best].dot(towards(azimuth_deg).cast<double>()))
      best = i;
  const auto l = m.response(best, 0), r = m.response(best, 1);
  return {{l.begin(), l.end()}, {r.begin(), r.end()}};
}

// Response to a unit impulse at 1 m from there.
inline BinauralResponse rendered_response(const Eigen::Vector3f& direction, int blocks = 8) {
  static const auto hrtf = ears();
  Spatialiser spatialiser({hrtf, nullptr}, 1, 48000, Instructions::kSse2);
  spatialiser.begin(0);
  BinauralResponse output;
  for (int b = 0; b < blocks; ++b) {
    std::vector<float> in(kMaxBlock), out(2 * kMaxBlock);
    if (b == 0) in[0] = 1;
    spatialiser.add(0, {direction, 1}, in.data(), kMaxBlock);
    spatialiser.mix(out.data(), kMaxBlock);
    for (std::size_t n = 0; n < kMaxBlock; ++n)
      output.left.push_back(static_cast<double>(out[2 * n])),
          output.right.push_back(static_cast<double>(out[2 * n + 1]));
  }
  return output;
}

inline std::complex<double> spectrum_at(const std::vector<double>& x, double frequency_Hz, double rate_Hz) {
  std::complex<double> sum = 0;
  for (std::size_t n = 0; n < x.size(); ++n)
    sum += x[n] * std::polar(1.0, -2 * std::numbers::pi * frequency_Hz * static_cast<double>(n) / rate_Hz);
  return sum;
}

// In both functions each frequency has equal weight, so that a filter common to both ears has no effect.
//
// Delay of the left ear relative to the right, microseconds: the maximum of the cross-correlation below
// `up_to_Hz`, from the cross-spectrum on a grid of 50 Hz, independent of the sample rate.
inline double time_difference_us(const BinauralResponse& ears, double rate_Hz, double up_to_Hz = 1500) {
  std::vector<std::complex<double>> cross;
  for (double f = 50; f <= up_to_Hz; f += 50) {
    const auto left = spectrum_at(ears.left, f, rate_Hz), right = spectrum_at(ears.right, f, rate_Hz);
    cross.push_back(std::conj(left) * right / (std::norm(left) + std::norm(right)));
  }
  double best_us = 0, most = -1e300;
  for (double us = -1000; us <= 1000; us += 1) {
    double sum = 0, f = 50;
    for (const auto& c : cross)
      sum += std::real(c * std::polar(1.0, 2 * std::numbers::pi * f * -us * 1e-6)), f += 50;
    if (sum > most) most = sum, best_us = us;
  }
  return best_us;
}

// Energy of the left ear over that of the right between two frequencies, dB.
inline double level_difference_dB(const BinauralResponse& ears, double rate_Hz, double from_Hz, double to_Hz) {
  double left = 0, right = 0;
  for (double f = from_Hz; f < to_Hz; f += 50) {
    const double l = std::norm(spectrum_at(ears.left, f, rate_Hz)),
                 r = std::norm(spectrum_at(ears.right, f, rate_Hz));
    left += l / (l + r), right += r / (l + r);
  }
  return 10 * std::log10(left / right);
}

}  // namespace tactus::audio::test
