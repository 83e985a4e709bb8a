// Sobol points: they fill the unit cube more evenly than random points. Pure.
#pragma once

#include <cstdint>
#include <vector>

namespace tactus::observer {

// Coordinates for which direction numbers are stored.
constexpr int kMaxSobolDimensions = 48;

// Point `index` (0, 1, ...) of the Sobol sequence of Joe and Kuo 2008 ("Constructing Sobol sequences with better
// two-dimensional projections", SIAM Journal on Scientific Computing 30; direction numbers of their file
// new-joe-kuo-6), 32 bits, in [0, 1). Throws std::invalid_argument when dimensions is below 1 or above
// kMaxSobolDimensions.
std::vector<double> sobol_point(std::uint32_t index, int dimensions);

// The same point after nested uniform scrambling with this seed, in (0, 1), never 0 or 1 (Owen 1995, "Randomly
// permuted (t,m,s)-nets and (t,s)-sequences"; one random bit for each prefix of bits). The first 2^m points have
// exactly one point in each interval of length 2^-m of every coordinate.
std::vector<double> scrambled_sobol_point(std::uint32_t index, int dimensions, std::uint64_t seed);

}  // namespace tactus::observer
