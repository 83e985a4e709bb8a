#include "thermal_node/skin/erfcx.h"

#include <cmath>
#include <numbers>

namespace tactus::thermal {
namespace {

// Above this value the continued fraction converges to double precision in kTerms terms. Below it the erfc of the
// C library is far from its underflow (x = 26), and exp(x^2) loses at most x^2 units of rounding, 16 here.
constexpr double kSwitch = 4;
constexpr int kTerms = 60;

}  // namespace

double erfcx(double x) {
  if (x < kSwitch) return std::exp(x * x) * std::erfc(x);
  // Laplace's continued fraction (Abramowitz and Stegun 1964, 7.1.14), from its tail: sqrt(pi) erfcx(x) = 1/(x +
  // (1/2)/(x + (2/2)/(x + (3/2)/(x + ...)))).
  double tail = x;
  for (int n = kTerms; n >= 1; --n) tail = x + 0.5 * n / tail;
  return std::numbers::inv_sqrtpi / tail;
}

}  // namespace tactus::thermal
