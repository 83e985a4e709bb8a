#include "sync/random/jitter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sync/random/keyed_random.h"

namespace tactus::sync {
namespace {

// Multiples of the standard deviation that a normal jitter needs on each side: cutting it there changes its deviation by
// 0.25 % (moments() below), which no test of a stream of less than 80,000 items can see.
constexpr double kNormalReach = 3;

double density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi); }

DelayMoments moments_of_trace(const std::vector<double>& trace_s) {
  if (trace_s.empty()) return {};
  DelayMoments m;
  for (const double x : trace_s) m.mean_s += x / static_cast<double>(trace_s.size());
  double square = 0;
  for (const double x : trace_s) square += (x - m.mean_s) * (x - m.mean_s) / static_cast<double>(trace_s.size());
  m.sd_s = std::sqrt(square);
  return m;
}

}  // namespace

double needed_delay_s(const JitterDef& def) {
  return def.shape == JitterShape::kUniform ? def.scale_s : def.shape == JitterShape::kNormal ? kNormalReach * def.scale_s : 0;
}

DelayMoments moments(const JitterDef& def, double limit_s) {
  if (def.shape == JitterShape::kTrace) return moments_of_trace(def.trace_s);
  // Lomax 1954 with index a: sd = mean sqrt(a / (a - 2)).
  if (def.shape == JitterShape::kPareto) return {def.scale_s, def.scale_s * std::sqrt(kParetoIndex / (kParetoIndex - 2))};
  if (def.scale_s <= 0) return {};
  const double c = limit_s / def.scale_s;
  // E min(x^2, c^2): for a uniform x in (-1, 1), c^2 - 2 c^3 / 3 below 1; for a standard normal x, by parts,
  // 1 - 2 ((1 - c^2) Q(c) + c phi(c)).
  const double square = def.shape == JitterShape::kUniform
                            ? (c >= 1 ? 1.0 / 3 : c * c - 2 * c * c * c / 3)
                            : 1 - 2 * ((1 - c * c) * (1 - normal_cdf(c)) + c * density(c));
  return {0, def.scale_s * std::sqrt(square)};
}

DelayMoments moments_cut_at_zero(const JitterDef& def) {
  // Of max(x, 0): uniform in (-1, 1): mean 1/4, mean square 1/6; standard normal: mean 1/sqrt(2 pi), mean square 1/2.
  const bool uniform_shape = def.shape == JitterShape::kUniform;
  const double mean = uniform_shape ? 0.25 : 1 / std::sqrt(2 * std::numbers::pi), square = uniform_shape ? 1.0 / 6 : 0.5;
  return {def.scale_s * mean, def.scale_s * std::sqrt(square - mean * mean)};
}

Nanoseconds Jitter::next(double u) {
  if (def_.shape == JitterShape::kTrace)
    return def_.trace_s.empty() ? Nanoseconds(0) : from_seconds(def_.trace_s[trace_index_++ % def_.trace_s.size()]);
  const double innovation = normal_quantile(u);
  const double rho = def_.correlation;
  z_ = started_ ? rho * z_ + std::sqrt(1 - rho * rho) * innovation : innovation;
  started_ = true;
  if (def_.shape == JitterShape::kNormal) return std::clamp(from_seconds(def_.scale_s * z_), -limit_, limit_);
  const double p = rho == 0 ? u : normal_cdf(z_);
  if (def_.shape == JitterShape::kUniform)
    return std::clamp(from_seconds(def_.scale_s * (2 * p - 1)), -limit_, limit_);
  // Lomax, Pareto shifted to begin at 0: its mean is scale / (index - 1).
  const double scale_s = def_.scale_s * (kParetoIndex - 1);
  return from_seconds(scale_s * (std::pow(1 - p, -1 / kParetoIndex) - 1));
}

}  // namespace tactus::sync
