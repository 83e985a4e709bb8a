// No setting of haptic_node within its range and no operator on its output makes touch less safe. The table
// tests/bench/haptic_node/settings_table.cpp draws many more.
#include <catch2/catch.hpp>
#include <random>

#include "tests/haptic_node/support/trial.h"

using namespace tactus::haptic::test;

TEST_CASE("With random settings and operators touch stays within its limits of energy, force, rise, fade and reaction") {
  std::mt19937 random(30);
  for (int round = 0; round < 200; ++round) {
    const TrialDef def = random_trial(random);
    const TrialResult r = run_trial(def);
    CAPTURE(round, describe(def), describe(r));
    CHECK(faults(def, r) == "");
  }
}
