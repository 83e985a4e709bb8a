#include "sync/random/jitter.h"

#include <cmath>

#include "sync/random/keyed_random.h"

namespace tactus::sync {

Nanoseconds Jitter::next(double u) {
  if (def_.shape == JitterShape::kTrace)
    return def_.trace_s.empty() ? Nanoseconds(0) : from_seconds(def_.trace_s[trace_index_++ % def_.trace_s.size()]);
  const double innovation = normal_quantile(u);
  const double rho = def_.correlation;
  z_ = started_ ? rho * z_ + std::sqrt(1 - rho * rho) * innovation : innovation;
  started_ = true;
  if (def_.shape == JitterShape::kNormal) return from_seconds(def_.scale_s * z_);
  const double p = rho == 0 ? u : normal_cdf(z_);
  if (def_.shape == JitterShape::kUniform) return from_seconds(def_.scale_s * (2 * p - 1));
  // Lomax, Pareto shifted to begin at 0: its mean is scale / (index - 1).
  const double scale_s = def_.scale_s * (kParetoIndex - 1);
  return from_seconds(scale_s * (std::pow(1 - p, -1 / kParetoIndex) - 1));
}

}  // namespace tactus::sync
