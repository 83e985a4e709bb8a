// Whether a player of the population may play: the twelve checks of observer/checks, which depend on its properties. A player
// that fails one is refused, or its games are counted as those of a player that is not like people. Pure.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scripts/simulated_player/observer/checks/checks.h"
#include "scripts/simulated_player/player_choice.h"

namespace tactus::simulated_player {

// kRequire: a player that fails a check does not play. kCount: it plays, and the failed checks are reported. kSkip: the caller
// has checked it.
enum class CheckPolicy : std::uint8_t { kRequire, kCount, kSkip };

// "require", "count" or "skip". Throws std::runtime_error with one sentence for any other word.
CheckPolicy check_policy(const std::string& word);

// The results of the players so far: a check takes seconds.
class Admission {
 public:
  // Numbers of the checks that a player fails with this seed, or only of the first one.
  using Checks = std::function<std::vector<int>(const observer::PlayerParameters&, std::uint64_t seed, bool first_only)>;
  // checks: in place of observer::failing_checks, for tests.
  explicit Admission(Checks checks = observer::failing_checks) : checks_(std::move(checks)) {}

  // Numbers of the checks that this player fails, with the population's seed for the experiments; empty: it may be asked. Only
  // the first failed one under kRequire. Under kSkip, for stage_model and for the typical person, whose checks are tests of the
  // library, no check is run.
  const std::vector<int>& failed(const PlayerChoice& choice, std::uint64_t population, CheckPolicy policy);
  // As failed(). Under kRequire it throws std::runtime_error with one sentence when the player fails a check.
  const std::vector<int>& admit(const PlayerChoice& choice, std::uint64_t population, CheckPolicy policy);

 private:
  Checks checks_;
  std::map<std::pair<std::int64_t, std::uint64_t>, std::vector<int>> first_, all_;  // by number and population
};

// "observer:17 of population 1 fails the checks 2 and 3"; failed is not empty.
std::string failed_sentence(const PlayerChoice& choice, std::uint64_t population, const std::vector<int>& failed);

}  // namespace tactus::simulated_player
