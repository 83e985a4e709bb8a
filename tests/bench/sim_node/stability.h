// What the proofs of stability share.
#pragma once

#include "sim_node/behaviour/impulse/penalty.h"
#include "tests/sim_node/support/toys.h"

namespace tactus::sim::bench {

inline constexpr double kLightest_kg = 0.05, kDampingRatio = 0.05;
inline constexpr double kStiffestTried = 1e5;  // k h^2 / m: far beyond what any explicit step bears
using test::kToyG;

// A tower of boxes, or a ball, at rest in a shell that is so many times as thick as one of them bends its springs:
// there spring and damper are linear.
inline constexpr double kBends = 8;
static_assert(kBends * impulse::kDamperSetsIn < 1);
inline double bend_m(double k) { return kLightest_kg * kToyG / k; }

// The largest value at which stays(value) holds, to 1 %, sought downwards from `most` to `least`; 0: none.
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
