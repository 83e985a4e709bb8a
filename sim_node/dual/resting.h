// Bodies at rest that need not be computed: islands of bodies joined by contacts, all of which have been still for a
// while. An island wakes as a whole. Pure.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/dual/swept_trajectories.h"
#include "sim_node/model/state_archive.h"
#include "sync/time/time.h"

namespace tactus::sim {

class Resting {
 public:
  // An island sleeps when all its bodies are slower than this for kStillFor, as in ODE (Smith 2006, ODE manual 5.6:
  // 0.01 m/s, 0.01 rad/s). kStillFor is half a second by design: a body that is about to tip starts to move within
  // it.
  static constexpr double kStill_m_s = 0.01, kStill_rad_s = 0.01;
  static constexpr sync::Nanoseconds kStillFor{500'000'000};

  // may_rest: one flag per body of the world; bodies without joints may rest.
  explicit Resting(std::vector<char> may_rest);

  // Call at the end of a step of this length. bodies: the computed bodies; motions: of all bodies. touching: pairs
  // that touch; one of a pair may rest already. supported: bodies that touch something. Returns the bodies that rest
  // from now on, ascending.
  std::span<const int> settle(std::span<const int> bodies, std::span<const BodyMotion> motions,
                              std::span<const std::pair<int, int>> touching, std::span<const char> supported,
                              sync::Nanoseconds length);
  // Resting bodies near enough to these trajectories, within the horizon, for contact to be possible; ascending.
  // motions, radii_m: of all bodies.
  std::span<const int> near(std::span<const SweptSphere> trajectories, std::span<const BodyMotion> motions,
                            std::span<const double> radii_m, double horizon_s);
  // Wakes the islands of these bodies; returns the woken bodies, ascending.
  std::span<const int> wake_with(std::span<const int> bodies);
  std::span<const int> wake_all();
  std::span<const int> resting() const { return resting_; }

  bool rests(int body) const { return island_[static_cast<std::size_t>(body)] >= 0; }
  std::size_t count() const { return resting_.size(); }
  void archive(StateArchive& a);

 private:
  void rebuild(std::span<const BodyMotion> motions, std::span<const double> radii_m);
  std::span<const int> wake_islands();

  std::vector<char> may_rest_;
  std::vector<sync::Nanoseconds> still_for_;  // per body
  std::vector<int> island_;                   // island of each resting body; -1: awake
  std::vector<int> resting_;                  // ascending
  bool stale_ = true;                         // the grid does not match resting_
  std::vector<Bounds> boxes_;
  BoundsGrid grid_;
  std::vector<int> parent_, found_, near_, changed_, woken_islands_;
  std::vector<char> calm_;
};

}  // namespace tactus::sim
