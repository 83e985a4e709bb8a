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

// The largest value for which stays(value) holds, to 1 %, searched downwards from `most` to `least`; 0: none.
template <class Stays>
double largest(double most, double least, Stays stays) {
  double low = most, high = most;
  for (; !stays(low); low /= 1.5) {
    if (low < least) return 0;
    high = low;
  }
  while (high / low > 1.01) {
    const double middle = std::sqrt(low * high);
    (stays(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace tactus::sim::bench
