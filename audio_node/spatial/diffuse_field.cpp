#include "audio_node/spatial/diffuse_field.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace tactus::audio {
namespace {

constexpr std::size_t kBins = 512;  // of the spectrum, around the circle
// Maximum boost or cut relative to the mean: where the loudspeaker emits nothing there is only noise to raise.
constexpr double kMax = 1.73;  // 15 dB, as a natural logarithm; design

constexpr double kMinPower = 1e-15;  // far below any response; avoids the logarithm of zero

// Its spectrum is the mean of the powers, at a fraction of the cost of one spectrum per response.
std::vector<double> mean_autocorrelation(const std::vector<std::vector<float>>& responses,
                                         const std::vector<double>& weights) {
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<double> mean(responses.front().size());
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const Eigen::Map<const Eigen::VectorXf> x(responses[i].data(), static_cast<Eigen::Index>(responses[i].size()));
    for (Eigen::Index lag = 0; lag < x.size(); ++lag) {
      const auto product = static_cast<double>(x.head(x.size() - lag).dot(x.tail(x.size() - lag)));
      mean[static_cast<std::size_t>(lag)] += weights[i] / all * product;
    }
  }
  return mean;
}

}  // namespace

std::vector<float> diffuse_field_inverse(const std::vector<std::vector<float>>& responses,
                                         const std::vector<double>& weights, int taps) {
  const std::vector<double> correlation = mean_autocorrelation(responses, weights);
  std::vector<double> cosine(kBins);
  for (std::size_t i = 0; i < kBins; ++i)
    cosine[i] = std::cos(2 * std::numbers::pi * static_cast<double>(i) / kBins);
  std::vector<double> inverse(kBins / 2 + 1);  // logarithm of its magnitude
  double middle = 0;
  for (std::size_t k = 0; k < inverse.size(); ++k) {
    double power = 0;
    for (std::size_t lag = 0; lag < correlation.size(); ++lag)
      power += (lag > 0 ? 2 : 1) * correlation[lag] * cosine[k * lag % kBins];
    inverse[k] = -0.5 * std::log(std::max(power, kMinPower));
    middle += inverse[k] / static_cast<double>(inverse.size());
  }
  for (double& x : inverse) x = std::clamp(x, middle - kMax, middle + kMax);
  // The minimum-phase cepstrum, and its response by the recursion of Oppenheim and Schafer, Discrete-Time Signal
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
