// Definitions shared by the stability proofs.
#pragma once

#include "sim_node/behaviour/impulse/penalty.h"
#include "tests/sim_node/support/toys.h"

namespace tactus::sim::bench {

inline constexpr double kLightest_kg = 0.05, kDampingRatio = 0.05;
inline constexpr double kStiffestTried = 1e5;  // k h^2 / m: far beyond the limit of any explicit step
using test::kToyG;

// A tower of boxes, or a ball, rests in a shell kBends times as thick as the deflection of its springs under one of them: there spring and
// damper are linear.
inline constexpr double kBends = 8;
static_assert(kBends * impulse::kDampingOnsetShare < 1);
inline double bend_m(double k) { return kLightest_kg * kToyG / k; }

// The largest value for which is_stable(value) holds, to 1 %, searched downwards from `max` to `min`; 0: none.
template <class IsStable>
double largest_stable(double max, double min, IsStable is_stable) {
  double low = max, high = max;
  for (; !is_stable(low); low /= 1.5) {
    if (low < min) return 0;
    high = low;
  }
  while (high / low > 1.01) {
    const double middle = std::sqrt(low * high);
    (is_stable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace tactus::sim::bench
