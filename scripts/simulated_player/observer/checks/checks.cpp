#include "scripts/simulated_player/observer/checks/checks.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace tactus::observer {
namespace {

// Fast checks first, then those that most players fail.
constexpr std::array kFastFirst{4, 9, 5, 7, 6, 8, 12, 1, 2, 3, 11, 10};

bool fails(const std::vector<CheckResult>& results, int check) {
  return std::any_of(results.begin(), results.end(),
                     [&](const CheckResult& r) { return r.check == check && !r.passed(); });
}

std::vector<CheckResult> only(std::vector<CheckResult> results, int check) {
  std::erase_if(results, [&](const CheckResult& r) { return r.check != check; });
  return results;
}

}  // namespace

std::vector<CheckResult> run_check(int check, const PlayerParameters& player, std::uint64_t seed,
                                   const CheckEffort& effort) {
  switch (check) {
    case 1:
    case 2:
    case 3: return only(check_pointing(player, seed, effort), check);
    case 4: return check_responses(player);
    case 5: return check_reach(player, seed, effort);
    case 6: return check_size(player, seed, effort);
    case 7: return check_ventriloquism(player, seed, effort);
    case 8: return check_thresholds(player, seed, effort);
    case 9: return check_recalibration(player, seed, effort);
    case 10: return check_jitter(player, seed, effort);
    case 11: return check_reckoning(player, seed, effort);
    case 12: return check_removed_sense(player, seed, effort);
    default: throw std::invalid_argument("checks: there is no check " + std::to_string(check) + "; use 1 to 12");
  }
}

std::vector<CheckResult> run_checks(const PlayerParameters& player, std::uint64_t seed,
                                    const CheckEffort& effort) {
  std::vector<CheckResult> all = check_pointing(player, seed, effort);  // checks 1, 2 and 3 share their trials
  for (int check = 4; check <= kChecks; ++check) {
    const auto results = run_check(check, player, seed, effort);
    all.insert(all.end(), results.begin(), results.end());
  }
  return all;
}

std::vector<int> failing_checks(const PlayerParameters& player, std::uint64_t seed, bool first_only) {
  std::vector<int> failing;
  std::vector<CheckResult> pointing;
  for (int check : kFastFirst) {
    if (check <= 3 && pointing.empty()) pointing = check_pointing(player, seed, {});
    if (fails(check <= 3 ? pointing : run_check(check, player, seed), check)) failing.push_back(check);
    if (first_only && !failing.empty()) break;
  }
  std::sort(failing.begin(), failing.end());
  return failing;
}

void require_admitted(const PlayerParameters& player, std::uint64_t seed) {
  const std::vector<int> failing = failing_checks(player, seed, true);
  if (!failing.empty())
    throw std::runtime_error("simulated player: fails check " + std::to_string(failing.front()) +
                             "; choose another player of the population");
}

}  // namespace tactus::observer
