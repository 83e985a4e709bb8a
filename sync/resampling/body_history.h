// Where the bodies are at an instant, from WORLD_STATE: interpolated between snapshots, extrapolated by a bounded
// time. Pure.
//
// Bodies that are computed ahead are told for an instant to come, so that the newest sample of a body is not where
// it is now. When one is touched before that instant it is told anew, and what was said ahead of it holds no more:
// whichever of the two pages comes first.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <tactus/world_state_t.hpp>

#include "sync/resampling/sample_status.h"
#include "sync/clocks/sim_clock_tracker.h"
#include "sync/time/time.h"

namespace tactus::sync {

struct BodyPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, world
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          // m/s, world
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  // rad/s, world
};

class BodyHistory {
 public:
  // Past the newest sample a body moves on with its velocity for so long, then it is held, then stale: three
  // snapshots at 60 Hz may be missed before it stops.
  static constexpr Nanoseconds kExtrapolateAtMost{50'000'000};
  static constexpr Nanoseconds kStaleAfter{200'000'000};
  // At the least, however old; and so much of the past, as far as kMaxSamples reaches, so that a sense may present
  // that late.
  static constexpr std::size_t kSamplesPerBody = 64;
  static constexpr Nanoseconds kSpan{1'000'000'000};
  // More bodies cannot be told of once a second: 2,000 pages of 18.
  static constexpr int kMaxBodies = 36'000;
  // Of all bodies together, some 64 MB: when there are more, each keeps fewer.
  static constexpr std::size_t kMaxSamples = 1 << 19;

  explicit BodyHistory(OwnClock own) : follower_(own) {}

  // A sense asks for what is so long ago: so much more than kSpan is kept.
  void keep(Nanoseconds delay) { span_ = kSpan + delay; }
  void push(const world_state_t& page, HostTime arrival);
  // Hermite in position, SLERP in orientation. A body at rest that a snapshot leaves out rests where it
  // was, and moves off no earlier than between the last two snapshots; one that moved was in a page that was lost,
  // and moves on as past the newest sample.
  Sample<BodyPose> pose(int body, SimTime t) const;
  // How the newest snapshot as a whole relates to t; it may be of an instant to come.
  SampleStatus status(SimTime t) const;
  std::optional<TimeMap> map(HostTime now) const { return follower_.map(now); }
  // Pages more than 1 s ahead of their simulation's own time, and bodies beyond kMaxBodies.
  std::int64_t refused() const { return refused_; }

 private:
  void forget_after(SimTime latest);

  struct Stamped {
    SimTime time;
    std::int64_t seq = 0;  // of its page: which was said first
    bool ahead = false;    // told for an instant to come
    Nanoseconds period{};  // between snapshots when it was told; 0: not known
    BodyPose pose;
  };
  using Samples = std::deque<Stamped>;  // in order of time, one per instant
  bool place(Samples& samples, Stamped fresh);
  void take_back(Samples& samples, const Stamped& now);
  SimClockTracker follower_;
  std::map<int, Samples> bodies_;
  std::size_t samples_kept_ = 0;
  Nanoseconds span_ = kSpan;
  std::optional<SimTime> newest_;
  std::int64_t refused_ = 0;
};

}  // namespace tactus::sync
