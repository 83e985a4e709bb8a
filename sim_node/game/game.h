// The game of a scene: which body lies in which hole, and whether all lie in theirs. Pure.
#pragma once

#include <span>
#include <tactus/game_state_t.hpp>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/world_def.h"
#include "sim_node/model/state_archive.h"
#include "sync/time/time.h"

namespace tactus::sim {

class Game {
 public:
  // A body counts as in a hole when it has been there for so long: one that bounces out again was not.
  static constexpr sync::Nanoseconds kSettles{100'000'000};

  explicit Game(std::vector<HoleDef> holes);

  bool any() const { return !holes_.empty(); }
  // Where the bodies are at `now`, the end of a step.
  void step(sync::SimTime now, std::span<const BodyMotion> bodies);
  // True once after each change of what describe() says.
  bool take_change() { return std::exchange(changed_, false); }
  // All but header and clock.
  void describe(game_state_t& out) const;
  bool won() const { return won_; }

  void archive(StateArchive& a, std::size_t bodies);

 private:
  struct Hole {
    HoleDef def;
    int candidate = -1;  // its centre is in there now
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
