// The fit of a cumulative normal to yes-no answers, for the simulated experiments. Pure.
#pragma once

#include <vector>

namespace tactus::observer {

// Answers at one level.
struct Level {
  double x = 0;
  double yes = 0, trials = 0;
};

struct NormalFit {
  double mean = 0, sd = 1;  // P(yes) = Phi((x - mean) / sd)
};

// Maximum likelihood (probit regression by Fisher scoring). Needs two levels with different x and a share of yes
// that rises with x; otherwise sd is infinite.
NormalFit fit_normal(const std::vector<Level>& levels);

}  // namespace tactus::observer
