// The setup of a game: moves each ball to a random place, so that no player can play it from memory. Pure, except for the
// bus.
#pragma once

#include <cstdint>
#include <tactus/scene_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <vector>

#include "scripts/simulated_player/rules.h"
#include "sync/bus/bus.h"

namespace tactus::simulated_player {

// The area for the balls: in front of their holes, apart from each other and from the objects in the room.
struct Scatter {
  double along_m = 0;  // half range towards or away from the hole, around the place in the scene
  double aside_m = 0;  // half range across
};

// A place for each ball, m, world: at rest on the floor; uniform, from the seed.
std::vector<Eigen::Vector3d> places(const Rules& rules, const scene_t& scene, const Scatter& scatter, std::uint64_t seed);

// Requests these places from the simulation until it has answered.
class Setup {
 public:
  Setup(sync::Bus& bus, const scene_t& scene, const Rules& rules, const std::vector<Eigen::Vector3d>& places, std::uint64_t seed);
  // Call it once a tick after the world has begun.
  void step(sync::HostTime now, sync::Queue<sim_reply_t>& replies);
  bool done() const { return commands_.empty(); }

 private:
  sync::Bus& bus_;
  std::vector<sim_command_t> commands_;  // not answered yet
  sync::HostTime next_{};
};

}  // namespace tactus::simulated_player
