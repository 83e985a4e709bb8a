// Random numbers by key: they depend on the item that they are drawn for, not on the time of drawing. The same seed gives the
// same decision for the same event or snapshot, in any order of arrival, live or from a log. Pure.
#pragma once

#include <cstdint>

namespace tactus::sync {

// 64 well-mixed bits of two words: the finaliser of SplitMix64 (Steele, Lea and Flood 2014, "Fast splittable
// pseudorandom number generators", figure 9) over their sum along its golden increment.
std::uint64_t mixed(std::uint64_t a, std::uint64_t b);

// Uniform in (0, 1), never 0 or 1.
double uniform(std::uint64_t seed, std::uint64_t key);

// Standard normal distribution and its inverse, p in (0, 1): the inverse is Wichura 1988, algorithm AS 241
// (PPND16), relative accuracy 1e-16.
double normal_cdf(double x);
double normal_quantile(double p);

}  // namespace tactus::sync
