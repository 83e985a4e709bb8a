// Spectrum in octaves, jitter and gaps of a contact force.
#include "tests/bench/offline/steadiness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::bench {
namespace {

constexpr double kWindow_s = 0.5, kFast_Hz = 20;

// rms in octaves relative to the mean, by a Fourier sum under a Hann window.
std::array<double, kBands> octaves(std::span<const double> x, double mean, double rate) {
  std::array<double, kBands> out{};
  const std::size_t n = x.size();
  for (std::size_t k = 1; k <= n / 2; ++k) {
    double re = 0, im = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
      const double w = (1 - std::cos(angle)) / 2 * (x[i] / mean - 1);
      re += w * std::cos(angle * static_cast<double>(k));
      im -= w * std::sin(angle * static_cast<double>(k));
    }
    const double f = static_cast<double>(k) * rate / static_cast<double>(n);
    const int band = std::min(kBands - 1, static_cast<int>(std::floor(std::log2(f))));
    // Parseval's theorem; 3/8 is the mean square of the window.
    if (band >= 0)
      out[static_cast<std::size_t>(band)] += 2 * (re * re + im * im) / (static_cast<double>(n * n) * 0.375);
  }
  return out;
}

}  // namespace

Steadiness steadiness(std::span<const std::vector<double>> series, double rate, bool all) {
  Steadiness out;
  std::vector<double> jitters;
  const auto length = static_cast<std::size_t>(kWindow_s * rate),
             half = static_cast<std::size_t>(rate / kFast_Hz / 2);
  std::size_t steps = 0, gone = 0;
  for (const auto& s : series)
    for (std::size_t begin = 0; begin + length <= s.size(); begin += length) {
      const std::span<const double> x(s.data() + begin, length);
      const auto without = static_cast<std::size_t>(std::count(x.begin(), x.end(), 0.0));
      if (without == length || (!all && without * 10 > length)) continue;
      steps += length, gone += without;
      double mean = 0;
      for (const double f : x) mean += f / static_cast<double>(length);
      double sum = 0, square = 0;
      std::size_t count = 0;
      for (std::size_t i = half; i + half < length; ++i) {
        double slow = 0;
        for (std::size_t k = i - half; k <= i + half; ++k) slow += x[k];
        slow /= static_cast<double>(2 * half + 1);
        square += (x[i] - slow) * (x[i] - slow);
        sum += slow;
        ++count;
      }
      jitters.push_back(std::sqrt(square / static_cast<double>(count)) / (sum / static_cast<double>(count)));
      const auto bands = octaves(x, mean, rate);
      for (std::size_t b = 0; b < bands.size(); ++b) out.bands[b] += bands[b];
    }
  out.windows = static_cast<int>(jitters.size());
  if (jitters.empty()) return out;
  std::nth_element(jitters.begin(), jitters.begin() + static_cast<std::ptrdiff_t>(jitters.size() / 2),
                   jitters.end());
  out.jitter = jitters[jitters.size() / 2];
  out.gone = static_cast<double>(gone) / static_cast<double>(steps);
  for (double& b : out.bands) b = std::sqrt(b / static_cast<double>(jitters.size()));
  return out;
}

}  // namespace tactus::bench
