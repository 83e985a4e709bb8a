// Spheroidal modes of a free solid ball, for any Poisson's ratio: the roots of their secular equation.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "audio_node/modal/modal.h"
#include "audio_node/modal/mode_range.h"

namespace tactus::audio {
namespace {

// All modes up to this k_t R are found. They are of the orders 0 to 7: order 8 begins above 8.6 for every Poisson's ratio.
constexpr double kHighestRoot = 8;
constexpr std::size_t kOrders = 8;
// No mode lies below: the lowest is 2.59, of order 2 with Poisson's ratio 0.
constexpr double kLowestRoot = 2;
// Roots of one order are 0.9 apart or more.
constexpr double kRootStep = 0.1;
// Closer to 0.5 the breathing mode is far above all others, and the recurrence of the Bessel functions overflows.
constexpr double kLargestPoissonsRatio = 0.4999;

// Spherical Bessel functions j_0 .. j_8 by downward recurrence, scaled by the sum of (2n + 1) j_n^2, which is 1 (Abramowitz and
// Stegun, Handbook of Mathematical Functions, 1964, eqs. 10.1.19 and 10.1.50).
using Bessels = std::array<double, kOrders + 1>;
Bessels spherical_bessels(double x) {
  constexpr int kStart = 40;  // beyond it they are below 1e-20 for x up to 8
  Bessels out{};
  double above = 0, value = 1e-30, sum = 0;
  for (int n = kStart; n >= 0; --n) {
    sum += (2 * n + 1) * value * value;
    if (n <= static_cast<int>(kOrders)) out[static_cast<std::size_t>(n)] = value;
    const double below = (2 * n + 1) / x * value - above;
    above = value, value = below;
  }
  for (double& j : out) j /= std::sqrt(sum);
  return out;
}

// Of each order: zero at a mode with x = k_t R (Eringen and Suhubi, Elastodynamics II, 1975, section 8.13). Order 0 has one
// condition, x cot x = 1 - (x c_l / c_t)^2 / 4 in x = k_l R.
std::array<double, kOrders> determinants(double x, double poissons_ratio) {
  const double h = x * std::sqrt((1 - 2 * poissons_ratio) / (2 * (1 - poissons_ratio)));
  const Bessels a = spherical_bessels(h), b = spherical_bessels(x);
  std::array<double, kOrders> out{};
  out[0] = 2 * h * a[1] - x * x / 2 * a[0];
  for (std::size_t i = 1; i < kOrders; ++i) {
    const double n = static_cast<double>(i);
    const double t11 = (n * n - n - x * x / 2) * a[i] + 2 * h * a[i + 1], t13 = n * (n + 1) * ((n - 1) * b[i] - x * b[i + 1]);
    const double t41 = (n - 1) * a[i] - h * a[i + 1], t43 = (n * n - 1 - x * x / 2) * b[i] + x * b[i + 1];
    out[i] = t11 * t43 - t13 * t41;
  }
  return out;
}

double bisected(double low, double high, std::size_t order, double poissons_ratio) {
  const bool sign = determinants(low, poissons_ratio)[order] < 0;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    ((determinants(middle, poissons_ratio)[order] < 0) == sign ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

std::vector<NaturalFrequency> solid_ball(const Elastic& m, double radius_m, ModeRange range) {
  const double nu = std::clamp(m.poissons_ratio, 0.0, kLargestPoissonsRatio);
  const double root_Hz = shear_speed_m_s(m) / (2 * std::numbers::pi * radius_m);
  const double end = std::min(kHighestRoot, range.below_Hz / root_Hz);
  std::vector<NaturalFrequency> all;
  auto before = determinants(kLowestRoot, nu);
  for (double x = kLowestRoot; x < end; x += kRootStep) {
    const double next = std::min(x + kRootStep, kHighestRoot);
    const auto now = determinants(next, nu);
    for (std::size_t order = 0; order < kOrders; ++order)
      if ((before[order] < 0) != (now[order] < 0))
        all.push_back({bisected(x, next, order, nu) * root_Hz, static_cast<int>(order)});
    before = now;
  }
  return in_range(std::move(all), range);
}

}  // namespace tactus::audio
