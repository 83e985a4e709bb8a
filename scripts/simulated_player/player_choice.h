// Which simulated player plays, as on the command line and in a request of play_games. Pure.
#pragma once

#include <cstdint>
#include <string>

namespace tactus::simulated_player {

// "stage_model": the player of fixed rules. "observer": the typical player of the observer library. "observer:N": player N
// of its population.
struct PlayerChoice {
  bool observer = false;
  std::int64_t number = -1;  // in the population; -1: the typical player
};

// Throws std::runtime_error with one sentence for any other name.
PlayerChoice player_choice(const std::string& name);

}  // namespace tactus::simulated_player
