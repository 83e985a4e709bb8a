#include "audio_node/samples/resample.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {
namespace {

using std::numbers::pi;

constexpr int kCrossings = 16;  // to each side
constexpr int kPhases = 512;    // of the table between two crossings; linear between: -108 dB (Smith, "Digital
                                // audio resampling", CCRMA 2002: error 12 bit + 2 log2 of 1/phase)

// Sinc under a Blackman-Harris window (Harris 1978, 4 terms, -92 dB), by distance in crossings.
const std::vector<double>& kernel() {
  static const std::vector<double> table = [] {
    std::vector<double> t(static_cast<std::size_t>(kCrossings * kPhases) + 2, 0.0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(kCrossings * kPhases); ++i) {
      const double x = static_cast<double>(i) / kPhases, w = pi * (1 + x / kCrossings);
      const double window =
          0.35875 - 0.48829 * std::cos(w) + 0.14128 * std::cos(2 * w) - 0.01168 * std::cos(3 * w);
      t[i] = window * (i == 0 ? 1 : std::sin(pi * x) / (pi * x));
    }
    return t;
  }();
  return table;
}

}  // namespace

std::vector<float> resample(const std::vector<float>& in, double from_Hz, double to_Hz) {
  if (from_Hz == to_Hz || in.empty()) return in;
  const double cutoff = std::min(1.0, to_Hz / from_Hz);  // of the bandwidth of the recording
  const double reach = kCrossings / cutoff;
  const auto& table = kernel();
  std::vector<float> out(static_cast<std::size_t>(std::ceil(static_cast<double>(in.size()) * to_Hz / from_Hz)));
  const auto last = static_cast<std::ptrdiff_t>(in.size()) - 1;
  for (std::size_t n = 0; n < out.size(); ++n) {
    const double at = static_cast<double>(n) * from_Hz / to_Hz;
    const auto first = std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(std::ceil(at - reach)));
    const auto end = std::min(last, static_cast<std::ptrdiff_t>(std::floor(at + reach)));
    double sum = 0;
    for (std::ptrdiff_t k = first; k <= end; ++k) {
      const double x = std::abs(static_cast<double>(k) - at) * cutoff * kPhases;
      const auto i = std::min(static_cast<std::size_t>(x), table.size() - 2);
      const double part = x - static_cast<double>(i);
      sum += static_cast<double>(in[static_cast<std::size_t>(k)]) * (table[i] + part * (table[i + 1] - table[i]));
    }
    out[n] = static_cast<float>(sum * cutoff);
  }
  return out;
}

}  // namespace tactus::audio
