// The poses of the bodies at an instant, from WORLD_STATE: interpolated between snapshots, extrapolated by a bounded time.
// Pure.
//
// The simulation publishes bodies that it computes ahead for a future instant, so the newest sample of a body may lie in the
// future. When such a body is touched before that instant, the simulation publishes it again, and the earlier predictions are
// void, in whichever order the two pages arrive.
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
  // Extrapolation: after its newest sample a body continues with its velocity for this time; then its pose is held, then
  // stale. Three snapshots at 60 Hz may be missing before the body stops.
  static constexpr Nanoseconds kMaxExtrapolation{50'000'000};
  static constexpr Nanoseconds kStaleAfter{200'000'000};
  // Minimum number of samples per body, of any age; and the length of the stored past, limited by kMaxSamples, which limits
  // the presentation delay of a modality.
  static constexpr std::size_t kSamplesPerBody = 64;
  static constexpr Nanoseconds kSpan{1'000'000'000};
  // Upper limit of the bodies that one snapshot a second can carry: 2,000 pages of 18.
  static constexpr int kMaxBodies = 36'000;
  // Maximum number of samples of all bodies together, about 64 MB. With more bodies, each keeps fewer samples.
  static constexpr std::size_t kMaxSamples = 1 << 19;

  explicit BodyHistory(OwnClock own) : clock_tracker_(own) {}

  // Stores this time beyond kSpan, for a modality that presents with this delay.
  void extend_history(Nanoseconds delay) { span_ = kSpan + delay; }
  void push(const world_state_t& page, HostTime arrival);
  // Hermite interpolation in position, SLERP in orientation. A body at rest that a snapshot leaves out rests at its last
  // pose, and starts to move no earlier than between the last two snapshots. A moving body that a snapshot leaves out was in
  // a lost page, and is extrapolated as after the newest sample.
  Sample<BodyPose> pose(int body, SimTime t) const;
  // The relation of the newest snapshot as a whole to t; its instant may lie in the future.
  SampleStatus status(SimTime t) const;
  std::optional<TimeMap> map(HostTime now) const { return clock_tracker_.map(now); }
  // Rejected pages more than 1 s ahead of their simulation's own time, and rejected bodies beyond kMaxBodies.
  std::int64_t refused() const { return refused_; }

 private:
  void discard_after(SimTime latest);

  struct TimedPose {
    SimTime time;
    std::int64_t seq = 0;  // of its page: the order of publication
    bool ahead = false;    // published for a future instant
    Nanoseconds period{};  // between snapshots at the time of publication; 0: not known
    BodyPose pose;
  };
  using Samples = std::deque<TimedPose>;  // in order of time, one per instant
  bool insert(Samples& samples, TimedPose sample);
  void discard_predictions(Samples& samples, const TimedPose& now);
  SimClockTracker clock_tracker_;
  std::map<int, Samples> bodies_;
  std::size_t sample_count_ = 0;
  Nanoseconds span_ = kSpan;
  std::optional<SimTime> newest_;
  std::int64_t refused_ = 0;
};

}  // namespace tactus::sync
