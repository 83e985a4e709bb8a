#include "scripts/simulated_player/observer_admission.h"

#include <catch2/catch.hpp>
#include <stdexcept>

#include "scripts/simulated_player/observer/checks/checks.h"
#include "scripts/simulated_player/observer/population.h"

using namespace tactus;
using namespace tactus::simulated_player;

namespace {

// The first player that fails the check of reaction times, which takes no time.
PlayerChoice slow_to_react(std::uint64_t population) {
  for (std::uint32_t number = 0; number < 4096; ++number) {
    bool passed = true;
    for (const auto& result : observer::run_check(4, observer::player_of(number, population), population)) passed = passed && result.passed();
    if (!passed) return player_choice("observer:" + std::to_string(number));
  }
  throw std::logic_error("no player fails check 4");
}

}  // namespace

TEST_CASE("A player of the population that fails a check is not asked, with one sentence that names player and check") {
  const PlayerChoice choice = slow_to_react(1);
  Admission admission;
  CHECK_THROWS_WITH(admission.admit(choice, 1, CheckPolicy::kRequire),
                    Catch::Contains("observer:" + std::to_string(choice.number) + " of population 1 fails the check 4") && Catch::Contains("--checks count"));
  CHECK(admission.failed(choice, 1, CheckPolicy::kRequire) == std::vector<int>{4});
}

TEST_CASE("Players of fixed rules and the typical person play without checks, as does a player whom the caller has checked") {
  Admission admission;
  CHECK(admission.admit(player_choice("stage_model"), 1, CheckPolicy::kRequire).empty());
  CHECK(admission.admit(player_choice("observer"), 1, CheckPolicy::kRequire).empty());
  CHECK(admission.admit(slow_to_react(1), 1, CheckPolicy::kSkip).empty());
}

TEST_CASE("The rule for failed checks is one of three words") {
  CHECK(check_policy("require") == CheckPolicy::kRequire);
  CHECK(check_policy("count") == CheckPolicy::kCount);
  CHECK(check_policy("skip") == CheckPolicy::kSkip);
  CHECK_THROWS_AS(check_policy("all"), std::runtime_error);
  CHECK(failed_sentence(player_choice("observer:17"), 3, {1, 2, 10}) == "observer:17 of population 3 fails the checks 1, 2 and 10");
}
