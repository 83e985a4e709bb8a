#include "audio_node/spatial/onset.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {
namespace {

using std::numbers::pi;

constexpr double kHalfWidth = 16;  // zeros; design: -0.1 dB at 0.9 of half of the rate
constexpr int kHalvings = 12;      // of one sample: 0.0002 of it is 5 ns

double peak_of(std::span<const float> samples) {
  float peak = 0;
  for (const float x : samples) peak = std::max(peak, std::abs(x));
  return static_cast<double>(peak);
}

}  // namespace

double value_at(std::span<const float> samples, double t, double cutoff) {
  const double reach = kHalfWidth / cutoff;
  const auto last = static_cast<long>(samples.size()) - 1;
  const long from = std::max(0L, static_cast<long>(std::ceil(t - reach)));
  const long to = std::min(last, static_cast<long>(std::floor(t + reach)));
  double sum = 0;
  for (long i = from; i <= to; ++i) {
    const double away = t - static_cast<double>(i), x = pi * cutoff * away;
    const double sinc = std::abs(x) < 1e-9 ? 1 : std::sin(x) / x;
    const double window = 0.5 + 0.5 * std::cos(pi * away / reach);
    sum += static_cast<double>(samples[static_cast<std::size_t>(i)]) * cutoff * sinc * window;
  }
  return sum;
}

double onset(std::span<const float> samples) {
  const double enough = kOnset * peak_of(samples);
  const auto reached = [&](double x) { return enough > 0 && std::abs(x) >= enough; };
  const auto first = std::find_if(samples.begin(), samples.end(), reached);
  if (first == samples.end() || first == samples.begin()) return 0;
  double after = static_cast<double>(first - samples.begin()), before = after - 1;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (before + after);
    (reached(value_at(samples, middle)) ? after : before) = middle;
  }
  return after;
}

std::size_t first_audible(std::span<const float> samples) {
  const double enough = kAudible * peak_of(samples);
  const auto reached = [&](float x) { return enough > 0 && static_cast<double>(std::abs(x)) >= enough; };
  const auto first = std::find_if(samples.begin(), samples.end(), reached);
  return first == samples.end() ? 0 : static_cast<std::size_t>(first - samples.begin());
}

}  // namespace tactus::audio
