// Bodies at rest that need not be computed: islands of bodies joined by contacts, all of which have been still for
// a while. An island wakes as a whole. Pure.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sim_node/dual/swept_trajectories.h"
#include "sim_node/model/body_motion.h"
#include "sim_node/model/state_archive.h"
#include "sync/time/time.h"

namespace tactus::sim {

class SleepingIslands {
 public:
  // An island sleeps when all its bodies are slower than this for kTimeToSleep, as in ODE (Smith 2006, ODE
  // manual 5.6: 0.01 m/s, 0.01 rad/s). kTimeToSleep is half a second by design: a body that is about to tip starts
  // to move within it.
  static constexpr double kSleepSpeed_m_s = 0.01, kSleepSpin_rad_s = 0.01;
  static constexpr sync::Nanoseconds kTimeToSleep{500'000'000};

  // may_sleep: one flag per body of the world; bodies without joints may sleep.
  explicit SleepingIslands(std::vector<char> may_sleep);

  // Call at the end of a step of this length. bodies: the computed bodies; motions: of all bodies. touching: pairs
  // that touch; one of a pair may sleep already. supported: bodies that touch something. Returns the bodies that
  // sleep from now on, ascending.
  std::span<const int> update(std::span<const int> bodies, std::span<const BodyMotion> motions,
                              std::span<const std::pair<int, int>> touching, std::span<const char> supported,
                              sync::Nanoseconds length);
  // Sleeping bodies near enough to these trajectories, within the horizon, for contact to be possible; ascending.
  // motions, radii_m: of all bodies.
  std::span<const int> near(std::span<const SweptSphere> trajectories, std::span<const BodyMotion> motions,
                            std::span<const double> radii_m, double horizon_s);
  // Wakes the islands of these bodies; returns the woken bodies, ascending.
  std::span<const int> wake_islands_of(std::span<const int> bodies);
  std::span<const int> wake_all();

  bool is_asleep(int body) const { return island_[static_cast<std::size_t>(body)] >= 0; }
  std::size_t count() const { return sleeping_.size(); }
  void archive(StateArchive& a);

 private:
  void rebuild(std::span<const BodyMotion> motions, std::span<const double> radii_m);
  std::span<const int> wake_islands();

  std::vector<char> may_sleep_;
  std::vector<sync::Nanoseconds> slow_for_;  // per body
  std::vector<int> island_;                  // island of each sleeping body; -1: awake
  std::vector<int> sleeping_;                // ascending
  bool stale_ = true;                        // the grid does not match sleeping_
  std::vector<Bounds> boxes_;
  BoundsGrid grid_;
  std::vector<int> parent_, found_, near_, changed_, woken_;
  std::vector<char> slow_;
};

}  // namespace tactus::sim
