#include "scripts/simulated_player/player_choice.h"

#include <charconv>
#include <limits>
#include <stdexcept>

namespace tactus::simulated_player {

PlayerChoice player_choice(const std::string& name) {
  const std::string observer = "observer";
  if (name == "stage_model") return {};
  if (name == observer) return {.observer = true, .number = -1};
  if (name.starts_with(observer + ":")) {
    std::uint32_t number = 0;
    const char *begin = name.data() + observer.size() + 1, *end = name.data() + name.size();
    const auto read = std::from_chars(begin, end, number);
    if (read.ec == std::errc() && read.ptr == end && begin != end) return {.observer = true, .number = number};
  }
  throw std::runtime_error("--player " + name + ": there is no such player; write stage_model, observer or observer:NUMBER");
}

}  // namespace tactus::simulated_player
