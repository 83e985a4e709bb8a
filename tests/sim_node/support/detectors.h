// The names of all detectors and solvers, for tests that cover each of them.
#pragma once

#include <string_view>

namespace tactus::sim::test {

inline constexpr std::string_view kDetectors[] = {"ode", "ccd", "ccd_mpr", "fcl", "layers", "gaps"};
inline constexpr std::string_view kSolvers[] = {"quick", "step", "impulse", "penalty", "penalty_explicit"};

}  // namespace tactus::sim::test
