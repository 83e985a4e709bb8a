// A-weighted equivalent level of the loudest second, computed independently of audio_node/signal: biquads from the
// poles of IEC 61672-1:2013, annex E, by the bilinear transform (as in the functions for Octave by Couvreur), and
// prefix sums.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace tactus::audio::test {

// One section in direct form II transposed.
class Biquad {
 public:
  Biquad(std::array<double, 3> b, std::array<double, 3> a) : b_(b), a_(a) {}
  double next(double x) {
    const double y = b_[0] * x + one_;
    one_ = b_[1] * x - a_[1] * y + two_;
    two_ = b_[2] * x - a_[2] * y;
    return y;
  }
  std::complex<double> at(std::complex<double> z) const {
    const std::complex<double> d = 1. / z;
    return (b_[0] + b_[1] * d + b_[2] * d * d) / (a_[0] + a_[1] * d + a_[2] * d * d);
  }

 private:
  std::array<double, 3> b_, a_;
  double one_ = 0, two_ = 0;
};

class WeightingOracle {
 public:
  explicit WeightingOracle(double rate_Hz) {
    const auto pole = [&](double f) {
      const double half = std::numbers::pi * f / rate_Hz;
      return (1 - half) / (1 + half);
    };
    const auto section = [&](double zero, double f, double g) {
      const double p = pole(f), q = pole(g);
      sections_.emplace_back(std::array<double, 3>{1, -2 * zero, zero * zero},
                             std::array<double, 3>{1, -p - q, p * q});
    };
    section(1, 20.598997, 20.598997);   // zeros at 0 Hz
    section(1, 107.65265, 737.86223);   // zeros at 0 Hz
    section(-1, 12194.217, 12194.217);  // zeros at infinity, which the transform moves to half the rate
    const std::complex<double> z = std::polar(1., 2 * std::numbers::pi * 1000 / rate_Hz);
    std::complex<double> h = 1;
    for (const Biquad& s : sections_) h *= s.at(z);
    gain_ = 1 / std::abs(h);
  }
  double next(double x) {
    for (Biquad& s : sections_) x = s.next(x);
    return gain_ * x;
  }

 private:
  std::vector<Biquad> sections_;
  double gain_ = 1;
};

// Level of the loudest second of interleaved samples, dBA; seconds that are cut by the end count too.
// ears: of the louder channel; otherwise the powers of the channels add up.
inline double loudest_second_by_oracle_dBA(const std::vector<float>& x, int channels, double rate_Hz,
                                           double full_scale_dB, bool ears) {
  const auto count = static_cast<std::size_t>(channels), frames = x.size() / count,
             second = static_cast<std::size_t>(std::lround(rate_Hz));
  double most = 0;
  std::vector<double> sum(frames + 1, 0.0);
  for (std::size_t c = 0; c < count; ++c) {
    WeightingOracle weighting(rate_Hz);
    double before = 0;
    for (std::size_t n = 0; n < frames; ++n) {
      const double y = weighting.next(static_cast<double>(x[n * count + c]));
      before += y * y;
      sum[n + 1] = before + (ears || c == 0 ? 0 : sum[n + 1]);
    }
    if (!ears && c + 1 < count) continue;
    for (std::size_t n = 1; n <= frames; ++n) most = std::max(most, sum[n] - sum[n > second ? n - second : 0]);
  }
  return full_scale_dB + 10 * std::log10(2 * most / rate_Hz + 1e-300);
}

}  // namespace tactus::audio::test
