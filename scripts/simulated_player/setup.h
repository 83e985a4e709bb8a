// How a game begins: each ball is put somewhere else by who leads the game, so that nobody can play it from memory. Pure but for
// the bus.
#pragma once

#include <cstdint>
#include <tactus/scene_t.hpp>
#include <tactus/sim_command_t.hpp>
#include <tactus/sim_reply_t.hpp>
#include <vector>

#include "scripts/simulated_player/rules.h"
#include "sync/bus/bus.h"

namespace tactus::participant {

// Where balls may lie: in front of their holes, out of reach of each other and of what stands in the room.
struct Scatter {
  double along_m = 0;  // towards or away from the hole, to either side of where the scene has it
  double aside_m = 0;  // across
};

// A place for each ball, m, world: at rest on the floor; uniform, from the seed.
std::vector<Eigen::Vector3d> places(const Rules& rules, const scene_t& scene, const Scatter& scatter, std::uint64_t seed);

// Asks the simulation for it, until it has answered.
class Setup {
 public:
  Setup(sync::Bus& bus, const scene_t& scene, const Rules& rules, const std::vector<Eigen::Vector3d>& places, std::uint64_t seed);
  // Once a tick, when the world has begun.
  void step(sync::HostTime now, sync::Queue<sim_reply_t>& replies);
  bool done() const { return commands_.empty(); }

 private:
  sync::Bus& bus_;
  std::vector<sim_command_t> commands_;  // not answered yet
  sync::HostTime next_{};
};

}  // namespace tactus::participant
