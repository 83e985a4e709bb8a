#include "scripts/simulated_player/observer/cue_combination.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::observer {
namespace {

double log_normal_density(double x, double variance) {
  return -0.5 * (x * x / variance + std::log(2 * std::numbers::pi * variance));
}

}  // namespace

Cue combine(std::span<const Cue> cues) {
  double information = 0, sum = 0;
  for (const Cue& cue : cues) {
    if (!std::isfinite(cue.variance)) continue;
    information += 1 / cue.variance;
    sum += cue.value / cue.variance;
  }
  if (information <= 0) return {0, std::numeric_limits<double>::infinity()};
  return {sum / information, 1 / information};
}

double aged_variance_m2(double sd_m, double age_s, double process_noise_m2_s) {
  return sd_m * sd_m + process_noise_m2_s * age_s;
}

CausalInference infer_cause(const Cue& a, const Cue& b, double prior_variance, double common_cause) {
  const double va = a.variance, vb = b.variance, vp = prior_variance;
  if (!std::isfinite(va) || !std::isfinite(vb)) {
    const double alone_a = std::isfinite(va) ? a.value / va / (1 / va + 1 / vp) : 0;
    const double alone_b = std::isfinite(vb) ? b.value / vb / (1 / vb + 1 / vp) : 0;
    return {common_cause, alone_a, alone_b};  // a cue without information says nothing about the cause
  }
  const double d = va * vb + va * vp + vb * vp, difference = b.value - a.value;
  // In logarithms, so that distant cues do not underflow.
  const double one = -(difference * difference * vp + b.value * b.value * va + a.value * a.value * vb) / (2 * d) -
                     std::log(2 * std::numbers::pi) - 0.5 * std::log(d);
  const double two = log_normal_density(b.value, vb + vp) + log_normal_density(a.value, va + vp);
  const double common = common_cause <= 0   ? 0
                        : common_cause >= 1 ? 1
                                            : 1 / (1 + (1 - common_cause) / common_cause * std::exp(two - one));
  const double fused = (a.value / va + b.value / vb) / (1 / va + 1 / vb + 1 / vp);
  const double alone_a = a.value / va / (1 / va + 1 / vp), alone_b = b.value / vb / (1 / vb + 1 / vp);
  return {common, common * fused + (1 - common) * alone_a, common * fused + (1 - common) * alone_b};
}

}  // namespace tactus::observer
