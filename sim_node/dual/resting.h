// Which bodies rest and need not be computed: those of an island, joined by contacts, that have all been still for
// a while. They wake together. Pure.
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
  // All bodies slower than this for so long, as ODE puts bodies to sleep (Smith 2006, ODE manual 5.6: 0.01 m/s,
  // 0.01 rad/s); design: half a second, in which a body that is about to tip has begun to.
  static constexpr double kStill_m_s = 0.01, kStill_rad_s = 0.01;
  static constexpr sync::Nanoseconds kStillFor{500'000'000};

  // may_rest: of each body of the world: free ones may.
  explicit Resting(std::vector<char> may_rest);

  // A step of that length has ended. bodies: those that were computed; motions: of all. touching: pairs that
  // touch, of which one may rest already. supported: bodies that touch something. Who rests from now on,
  // ascending.
  std::span<const int> settle(std::span<const int> bodies, std::span<const BodyMotion> motions,
                              std::span<const std::pair<int, int>> touching, std::span<const char> supported,
                              sync::Nanoseconds length);
  // Those that rest so near to these ways, within a horizon, that there may be contact; ascending. motions,
  // radii_m: of all.
  std::span<const int> near(std::span<const SweptSphere> ways, std::span<const BodyMotion> motions,
                            std::span<const double> radii_m, double horizon_s);
  // The islands of these wake; who does, ascending.
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
  std::vector<sync::Nanoseconds> still_for_;  // of each body
  std::vector<int> island_;                   // of each body that rests; -1
  std::vector<int> resting_;                  // ascending
  bool stale_ = true;                         // the grid is of others
  std::vector<Bounds> boxes_;
  BoundsGrid grid_;
  std::vector<int> parent_, found_, near_, changed_, woken_islands_;
  std::vector<char> calm_;
};

}  // namespace tactus::sim
