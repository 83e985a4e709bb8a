// Random settings of haptic_node and operators on its output, against the limits that protect the hand: energy, force,
// rise, fade after a failure, and the reaction of the body (tests/haptic_node/support/trial.h).
//
//    bin/settings_table [--trials N] [--seed N] [--print K] [--check]
//
// Prints the trials that pass a limit, the largest figures, and the number of trials of each kind. --print: only trial K,
// with all its settings. --check: exit 1 when a trial passes a limit.
#include <algorithm>
#include <cstdio>

#include "sync/node/node_options.h"
#include "tests/haptic_node/support/trial.h"

using namespace tactus::haptic::test;

int main(int argc, char** argv) {
  int trials = 4000, only = -1;
  unsigned seed = 1;
  bool check = false;
  tactus::sync::Arguments app{"Touch with random settings, against its limits."};
  app.add_option("--trials", trials, "number of trials").range(1, 10'000'000);
  app.add_option("--seed", seed, "seed of the settings");
  app.add_option("--print", only, "prints only this trial");
  app.add_flag("--check", check, "exit 1 when a trial passes a limit");
  tactus::sync::parse_or_exit(app, "settings_table", argc, argv);
  std::mt19937 random(seed);
  int bad = 0, touched = 0, walls = 0;
  double walls_mJ = 0, bodies_mJ = 0;
  for (int k = 0; k < trials; ++k) {
    const TrialDef def = random_trial(random);
    if (only >= 0 && k != only) continue;
    const TrialResult r = run_trial(def);
    const std::string list = faults(def, r);
    walls += def.mass_kg == 0;
    touched += r.peak_N > 0.01;
    double& max_mJ = def.mass_kg == 0 ? walls_mJ : bodies_mJ;
    max_mJ = std::max(max_mJ, r.generated_mJ - 1e3 * def.settings.generated_limit_J);
    bad += !list.empty();
    if (!list.empty() || only >= 0)
      std::printf("%6d %s: %s\n       %s\n", k, list.c_str(), describe(r).c_str(), describe(def).c_str());
  }
  std::printf("%d trials, %d at walls, %d with more than 0.01 N; %d beyond a limit\n", trials, walls, touched, bad);
  std::printf("largest generated energy beyond generated_limit: walls %.3f mJ, bodies %.3f mJ\n", walls_mJ, bodies_mJ);
  return check && bad > 0 ? 1 : 0;
}
