#include "audio_node/spatial/diffuse_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {
namespace {

constexpr std::size_t kBins = 512;  // of the spectrum, around the circle
// It never takes or gives more than that against the middle: where the loudspeaker gives nothing there is only
// noise to lift.
constexpr double kMost = 1.73;  // 15 dB, as a natural logarithm; design

}  // namespace

std::vector<float> diffuse_field_inverse(const std::vector<std::vector<float>>& responses, int taps) {
  std::vector<double> cosine(kBins);
  for (std::size_t i = 0; i < kBins; ++i)
    cosine[i] = std::cos(2 * std::numbers::pi * static_cast<double>(i) / kBins);
  const auto sine = [&](std::size_t i) { return cosine[(i + kBins * 3 / 4) % kBins]; };
  std::vector<double> inverse(kBins / 2 + 1);  // logarithm of its magnitude
  double middle = 0;
  for (std::size_t k = 0; k < inverse.size(); ++k) {
    double power = 1e-12;
    for (const auto& response : responses) {
      double re = 0, im = 0;
      for (std::size_t n = 0; n < response.size(); ++n) {
        const auto x = static_cast<double>(response[n]);
        re += x * cosine[k * n % kBins], im += x * sine(k * n % kBins);
      }
      power += re * re + im * im;
    }
    inverse[k] = -0.5 * std::log(power / static_cast<double>(responses.size()));
    middle += inverse[k] / static_cast<double>(inverse.size());
  }
  for (double& x : inverse) x = std::clamp(x, middle - kMost, middle + kMost);
  // The cepstrum of least phase, and its response by the recursion of Oppenheim and Schafer, Discrete-Time Signal
  // Processing, 3rd ed., eq. 13.57.
  const auto m = static_cast<std::size_t>(taps);
  std::vector<double> cepstrum(m), filter(m);
  for (std::size_t n = 0; n < m; ++n) {
    for (std::size_t k = 0; k < kBins; ++k)
      cepstrum[n] += inverse[std::min(k, kBins - k)] * cosine[k * n % kBins] / kBins;
    if (n > 0) cepstrum[n] *= 2;
  }
  filter[0] = std::exp(cepstrum[0]);
  for (std::size_t n = 1; n < m; ++n)
    for (std::size_t k = 1; k <= n; ++k)
      filter[n] += static_cast<double>(k) / static_cast<double>(n) * cepstrum[k] * filter[n - k];
  return {filter.begin(), filter.end()};
}

}  // namespace tactus::audio
