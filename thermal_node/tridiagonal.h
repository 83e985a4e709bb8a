// Systems of equations in which each unknown meets only its two neighbours. Pure.
#pragma once

#include <span>

namespace tactus::thermal {

// Solves lower[i] x[i-1] + centre[i] x[i] + upper[i] x[i+1] = right[i] (lower[0] and the last upper are not read)
// by Thomas' algorithm; x goes to `right`. All spans, `scratch` too, have the same length, at least 1. It needs no
// pivots when the matrix is diagonally dominant, as those of heat conduction are. Realtime-safe: yes.
void solve_tridiagonal(std::span<const double> lower, std::span<const double> centre,
                       std::span<const double> upper, std::span<double> right, std::span<double> scratch);

}  // namespace tactus::thermal
