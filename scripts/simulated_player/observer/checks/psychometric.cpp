#include "scripts/simulated_player/observer/checks/psychometric.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sync/random/keyed_random.h"

namespace tactus::observer {
namespace {

double density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi); }

// Step of Fisher scoring for P = Phi(a + b t).
void score(const std::vector<Level>& levels, double centre, double scale, double& a, double& b) {
  double aa = 1e-12, ab = 0, bb = 1e-12, ga = 0, gb = 0;
  for (const Level& l : levels) {
    const double t = (l.x - centre) / scale, z = std::clamp(a + b * t, -8.0, 8.0);
    const double p = std::clamp(sync::normal_cdf(z), 1e-12, 1 - 1e-12), phi = density(z), q = p * (1 - p);
    const double weight = l.trials * phi * phi / q, gradient = (l.yes - l.trials * p) * phi / q;
    aa += weight, ab += weight * t, bb += weight * t * t;
    ga += gradient, gb += gradient * t;
  }
  const double determinant = aa * bb - ab * ab;
  if (!(determinant > 0)) return;
  // A limited step keeps the scoring from leaving the range of the data.
  a += std::clamp((bb * ga - ab * gb) / determinant, -2.0, 2.0);
  b += std::clamp((aa * gb - ab * ga) / determinant, -2.0, 2.0);
}

}  // namespace

NormalFit fit_normal(const std::vector<Level>& levels) {
  if (levels.size() < 2) return {0, std::numeric_limits<double>::infinity()};
  const auto [low, high] =
      std::minmax_element(levels.begin(), levels.end(), [](const Level& p, const Level& q) { return p.x < q.x; });
  const double centre = (low->x + high->x) / 2, scale = (high->x - low->x) / 2;
  if (!(scale > 0)) return {centre, std::numeric_limits<double>::infinity()};
  double a = 0, b = 1;
  for (int i = 0; i < 60; ++i) score(levels, centre, scale, a, b);
  if (!(b > 0)) return {centre, std::numeric_limits<double>::infinity()};
  return {centre - a / b * scale, scale / b};
}

}  // namespace tactus::observer
