#include "scripts/simulated_player/observer_admission.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

#include "scripts/simulated_player/observer/population.h"

using namespace tactus;
using namespace tactus::simulated_player;

namespace {

// Checks of which this player of the population fails two, and every other player none.
Admission::Checks fails(std::uint32_t number, std::uint64_t population) {
  return [=](const observer::PlayerParameters& player, std::uint64_t seed, bool first_only) -> std::vector<int> {
    if (seed != population || player.caution != observer::player_of(number, population).caution) return {};
    return first_only ? std::vector{4} : std::vector{2, 4};
  };
}

}  // namespace

TEST_CASE("A player of the population that fails a check is not asked, with one sentence that names player and check") {
  const PlayerChoice choice = player_choice("observer:12");
  Admission admission(fails(12, 1));
  CHECK_THROWS_WITH(admission.admit(choice, 1, CheckPolicy::kRequire),
                    Catch::Contains("observer:" + std::to_string(choice.number) + " of population 1 fails the check 4") && Catch::Contains("--checks count"));
  CHECK(admission.failed(choice, 1, CheckPolicy::kRequire) == std::vector<int>{4});
  CHECK(admission.admit(choice, 1, CheckPolicy::kCount) == std::vector<int>{2, 4});
  CHECK(admission.admit(player_choice("observer:13"), 1, CheckPolicy::kRequire).empty());
}

TEST_CASE("Players of fixed rules and the typical person play without checks, as does a player whom the caller has checked") {
  Admission admission([](const observer::PlayerParameters&, std::uint64_t, bool) -> std::vector<int> { throw std::logic_error("a check ran"); });
  CHECK(admission.admit(player_choice("stage_model"), 1, CheckPolicy::kRequire).empty());
  CHECK(admission.admit(player_choice("observer"), 1, CheckPolicy::kRequire).empty());
  CHECK(admission.admit(player_choice("observer:12"), 1, CheckPolicy::kSkip).empty());
}

TEST_CASE("The rule for failed checks is one of three words") {
  CHECK(check_policy("require") == CheckPolicy::kRequire);
  CHECK(check_policy("count") == CheckPolicy::kCount);
  CHECK(check_policy("skip") == CheckPolicy::kSkip);
  CHECK_THROWS_AS(check_policy("all"), std::runtime_error);
  CHECK(failed_sentence(player_choice("observer:17"), 3, {1, 2, 10}) == "observer:17 of population 3 fails the checks 1, 2 and 10");
}
