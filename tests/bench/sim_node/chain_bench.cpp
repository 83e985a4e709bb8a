// Cost of a step of the chain of 22 degrees of freedom, and its energy error.
//
//    bin/chain_bench      for planar and spatial swings: us per step (p50, p99, largest, mean), energy error, sub-steps
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "tests/sim_node/support/articulated_trees.h"

using namespace tactus::sim;
using namespace tactus::sim::test;

int main() {
  std::printf("%-28s %8s %8s %8s %8s %12s %12s %9s\n", "chain of 11, 5 s at 1 ms", "mean us", "p50", "p99", "max",
              "energy end %", "worst %", "tries max");
  for (const bool vertical_first : {false, true})
    for (const double about_vertical : {0.0, 0.5}) {
      articulated::ArticulatedSystem s(vertical_first
                                           ? horizontal_chain(11, JointKind::kUniversal, {0, 0, 1}, {0, 1, 0})
                                           : horizontal_chain(11));
      auto state = s.state();
      state.rates[vertical_first ? 0 : 1] = about_vertical;
      s.set_state(state);
      const double scale = 2.968, start = energy_J(s);
      std::vector<double> us;
      double worst = 0, total = 0;
      int tries = 0;
      for (int i = 0; i < 5000; ++i) {
        const auto before = std::chrono::steady_clock::now();
        s.step(0.001);
        us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - before).count());
        total += us.back();
        tries = std::max(tries, s.substeps_last());
        worst = std::max(worst, std::abs(energy_J(s) - start) / scale * 100);
      }
      const double end = (energy_J(s) - start) / scale * 100;
      std::sort(us.begin(), us.end());
      std::printf("%-10s %-17s %8.1f %8.1f %8.1f %8.1f %12.4f %12.4f %9d\n",
                  about_vertical > 0 ? "0.5 rad/s" : "planar",
                  vertical_first ? "vertical first" : "horizontal first", total / 5000, us[2500], us[4950],
                  us.back(), end, worst, tries);
    }
}
