// Twelve checks that a simulated player passes before a result of it is quoted. Each simulates a published
// experiment, or a property that follows from the model, with the player's own percepts and movements. The bands
// are fixed; a player outside is not used. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scripts/simulated_player/observer/parameters.h"
#include "scripts/simulated_player/observer/population.h"

namespace tactus::observer {

constexpr int kChecks = 12;

// One measured value of a check. A check passes when all its values lie in their bands.
struct CheckResult {
  int check = 0;  // 1 to 12
  std::string quantity;
  std::string unit;
  double value = 0, low = 0, high = 0;  // passes when low <= value <= high; a value that is not a number fails
  std::string published;                // value in the source
  std::string source;
  Evidence evidence = Evidence::kDesign;
  bool passed() const { return value >= low && value <= high; }
};

// Trials of the simulated experiments: 1 for tests and decisions; a smaller share is faster and less exact.
struct CheckEffort {
  double share = 1;
};

// One check, 1 to 12, deterministic for a seed. Throws std::invalid_argument for another number.
std::vector<CheckResult> run_check(int check, const PlayerParameters& player, std::uint64_t seed,
                                   const CheckEffort& effort = {});

// All results, in order.
std::vector<CheckResult> run_checks(const PlayerParameters& player, std::uint64_t seed,
                                    const CheckEffort& effort = {});

// Numbers of the checks that fail, the fast checks first; empty: the player may be used. With first_only it ends
// at the first.
std::vector<int> failing_checks(const PlayerParameters& player, std::uint64_t seed, bool first_only = false);

// Throws std::runtime_error with the number of the first failing check when the player may not be used.
void require_admitted(const PlayerParameters& player, std::uint64_t seed);

// The checks by topic; run_check calls them.
std::vector<CheckResult> check_pointing(const PlayerParameters& player, std::uint64_t seed,
                                        const CheckEffort& effort);        // 1, 2, 3
std::vector<CheckResult> check_responses(const PlayerParameters& player);  // 4
std::vector<CheckResult> check_reach(const PlayerParameters& player, std::uint64_t seed,
                                     const CheckEffort& effort);  // 5
std::vector<CheckResult> check_size(const PlayerParameters& player, std::uint64_t seed,
                                    const CheckEffort& effort);  // 6
std::vector<CheckResult> check_ventriloquism(const PlayerParameters& player, std::uint64_t seed,
                                             const CheckEffort& effort);  // 7
std::vector<CheckResult> check_thresholds(const PlayerParameters& player, std::uint64_t seed,
                                          const CheckEffort& effort);  // 8
std::vector<CheckResult> check_recalibration(const PlayerParameters& player, std::uint64_t seed,
                                             const CheckEffort& effort);  // 9
std::vector<CheckResult> check_jitter(const PlayerParameters& player, std::uint64_t seed,
                                      const CheckEffort& effort);  // 10
std::vector<CheckResult> check_reckoning(const PlayerParameters& player, std::uint64_t seed,
                                         const CheckEffort& effort);  // 11
std::vector<CheckResult> check_removed_sense(const PlayerParameters& player, std::uint64_t seed,
                                             const CheckEffort& effort);  // 12

}  // namespace tactus::observer
