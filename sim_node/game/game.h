// The game of a scene: which body is in which hole, and whether every hole has its own body. Pure.
#pragma once

#include <span>
#include <tactus/game_state_t.hpp>
#include <utility>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/world_def.h"
#include "sim_node/model/state_archive.h"
#include "sync/time/time.h"

namespace tactus::sim {

class Game {
 public:
  // A body counts as in a hole after this time, so that a body that bounces out does not count.
  static constexpr sync::Nanoseconds kSettlingTime{100'000'000};

  explicit Game(std::vector<HoleDef> holes);

  bool any() const { return !holes_.empty(); }
  // Updates from the poses at `now`, the end of a step.
  void step(sync::SimTime now, std::span<const BodyMotion> bodies);
  // True once after each change of the data that describe() writes.
  bool take_change() { return std::exchange(changed_, false); }
  // Writes everything except header and clock.
  void describe(game_state_t& out) const;
  bool won() const { return won_; }

  void archive(StateArchive& a, std::size_t bodies);

 private:
  struct Hole {
    HoleDef def;
    int candidate = -1;  // body whose centre is in the hole now
    sync::SimTime since{};
    int inside = -1;
  };
  int body_in(const HoleDef& hole, std::span<const BodyMotion> bodies) const;

  std::vector<Hole> holes_;
  bool changed_ = true;
  bool won_ = false;
  sync::SimTime won_since_{};
};

}  // namespace tactus::sim
