// Shares of random decisions against their probability.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>

namespace tactus::sync {

inline constexpr int kN = 20'000;         // decisions of a test
inline constexpr double kSigmas = 4.5;    // a correct operator exceeds them once in 150,000 checks

// count of n decisions that have the probability p each.
inline void check_share(double count, double p, double n = kN) {
  CHECK(std::abs(count - p * n) <= kSigmas * std::sqrt(p * (1 - p) * n));
}

}  // namespace tactus::sync
