// The poses of the head as they were told, by the room's clock: every wall takes the same one and carries it on
// alike. Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <tactus/tool_state_t.hpp>

#include "sync/resampling/body_history.h"
#include "visual_node/frame/room_time.h"

namespace tactus::visual {

struct HeadSample {
  RoomTime sent;
  std::int64_t publish_ns = -1;  // as its sender said it
  std::int64_t seq = 0;          // of the message
  sync::BodyPose pose;
};

class HeadSamples {
 public:
  // design: as sync::PoseHistory
  static constexpr std::size_t kMax = 4096;
  static constexpr sync::Nanoseconds kSpan{1'000'000'000};

  void push(const tool_state_t& m, RoomTime sent);
  void forget() { samples_.clear(); }
  // When the newest was told; nothing: there is none.
  std::optional<RoomTime> newest() const {
    return samples_.empty() ? std::nullopt : std::optional(samples_.back().sent);
  }
  // The newest that had been told by t.
  std::optional<HeadSample> told_by(RoomTime t) const;

 private:
  std::int64_t incarnation_ = 0;
  std::deque<HeadSample> samples_;  // in order of time
};

// Where the head is at t, with the velocity that it had, for at most kCarryAtMost; and how good that is.
inline constexpr sync::Nanoseconds kCarryAtMost{50'000'000};  // design: what frame_lag is at the most of use
sync::Sample<sync::BodyPose> carried(const HeadSample& sample, RoomTime t);

}  // namespace tactus::visual
