#include "scripts/simulated_player/observer_admission.h"

#include <stdexcept>

#include "scripts/simulated_player/observer/population.h"

namespace tactus::simulated_player {

CheckPolicy check_policy(const std::string& word) {
  if (word == "require") return CheckPolicy::kRequire;
  if (word == "count") return CheckPolicy::kCount;
  if (word == "skip") return CheckPolicy::kSkip;
  throw std::runtime_error("--checks " + word + ": there is no such rule; write require, count or skip");
}

const std::vector<int>& Admission::failed(const PlayerChoice& choice, std::uint64_t population, CheckPolicy policy) {
  static const std::vector<int> none;
  if (policy == CheckPolicy::kSkip || !choice.observer || choice.number < 0) return none;
  auto& known = policy == CheckPolicy::kRequire ? first_ : all_;
  const auto key = std::make_pair(choice.number, population);
  if (const auto at = known.find(key); at != known.end()) return at->second;
  const observer::PlayerParameters player = observer::player_of(static_cast<std::uint32_t>(choice.number), population);
  return known[key] = checks_(player, population, policy == CheckPolicy::kRequire);
}

const std::vector<int>& Admission::admit(const PlayerChoice& choice, std::uint64_t population, CheckPolicy policy) {
  const std::vector<int>& numbers = failed(choice, population, policy);
  if (policy == CheckPolicy::kRequire && !numbers.empty())
    throw std::runtime_error(failed_sentence(choice, population, numbers) +
                             " and is not asked; choose another number (observer_players table), or add --checks count");
  return numbers;
}

std::string failed_sentence(const PlayerChoice& choice, std::uint64_t population, const std::vector<int>& failed) {
  std::string list;
  for (std::size_t i = 0; i < failed.size(); ++i)
    list += (i == 0 ? "" : i + 1 == failed.size() ? " and " : ", ") + std::to_string(failed[i]);
  return "observer:" + std::to_string(choice.number) + " of population " + std::to_string(population) + " fails the check" +
         (failed.size() > 1 ? "s " : " ") + list;
}

}  // namespace tactus::simulated_player
