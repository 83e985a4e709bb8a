#include "sim_node/game/game.h"

#include <algorithm>
#include <tactus/hole_state_t.hpp>

namespace tactus::sim {

Game::Game(std::vector<HoleDef> holes) {
  for (HoleDef& def : holes) holes_.push_back({std::move(def), -1, {}, -1});
}

// The body whose centre of mass is below the rim and within the wall. Only bodies that belong to a hole of the game
// count.
int Game::body_in(const HoleDef& hole, std::span<const BodyMotion> bodies) const {
  for (const Hole& other : holes_) {
    const Eigen::Vector3d from_rim = bodies[static_cast<std::size_t>(other.def.ball)].centre_m - hole.position_m;
    if (from_rim.head<2>().norm() <= hole.radius_m && from_rim.z() <= 0 && from_rim.z() >= -hole.depth_m)
      return other.def.ball;
  }
  return -1;
}

void Game::step(sync::SimTime now, std::span<const BodyMotion> bodies) {
  bool all = any();
  for (Hole& h : holes_) {
    const int found = body_in(h.def, bodies);
    if (found != h.candidate) {
      h.candidate = found;
      h.since = now;
    }
    const int inside = found == h.inside || now - h.since >= kSettlingTime || found < 0 ? found : -1;
    changed_ = changed_ || inside != h.inside;
    h.inside = inside;
    all = all && inside == h.def.ball;
  }
  if (all && !won_) won_since_ = now;
  won_ = all;
}

void Game::describe(game_state_t& out) const {
  out.won = won_ ? 1 : 0;
  out.won_ns = won_ ? sync::to_ns(won_since_) : -1;
  out.holes.clear();
  for (const Hole& h : holes_) {
    hole_state_t& s = out.holes.emplace_back();
    s.name = h.def.name;
    s.ball = h.def.ball;
    s.inside = h.inside;
    s.filled = h.inside == h.def.ball ? 1 : 0;
  }
  out.count = static_cast<std::int32_t>(out.holes.size());
}

void Game::archive(StateArchive& a, std::size_t bodies) {
  a.fixed(holes_, [&](Hole& h) { a.index(h.candidate, bodies), a(h.since), a.index(h.inside, bodies); });
  a(won_), a(won_since_);
  if (a.reads()) changed_ = true;
}

}  // namespace tactus::sim
