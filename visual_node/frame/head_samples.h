// Published poses of the head, by the room's clock: every wall selects the same one and extrapolates it alike.
// Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <tactus/tool_state_t.hpp>

#include "sync/clocks/single_sender.h"
#include "sync/resampling/body_history.h"
#include "visual_node/frame/room_time.h"

namespace tactus::visual {

struct HeadSample {
  RoomTime sent;
  std::int64_t publish_ns = -1;  // publish_time_ns of the message
  std::int64_t seq = 0;          // header.seq of the message
  sync::BodyPose pose;
};

class HeadSamples {
 public:
  // Design: as sync::PoseHistory.
  static constexpr std::size_t kMax = 4096;
  static constexpr sync::Nanoseconds kSpan{1'000'000'000};

  // Stores this time beyond kSpan, for a view that a profile delays.
  void extend_history(sync::Nanoseconds delay) { span_ = kSpan + delay; }
  // A report of the head. Those of a second process of the tool are ignored while the first one sends.
  void push(const tool_state_t& m, RoomTime sent, sync::HostTime arrival);
  // Whether a second process of the tool has sent within the last 0.3 s.
  bool conflict(sync::HostTime now) const { return followed_.conflict(now); }
  void clear() { samples_.clear(); }
  // Send time of the newest pose; nothing: there is none.
  std::optional<RoomTime> newest() const {
    return samples_.empty() ? std::nullopt : std::optional(samples_.back().sent);
  }
  // The newest pose that was published by t.
  std::optional<HeadSample> published_by(RoomTime t) const;

 private:
  sync::SingleSender followed_;
  std::deque<HeadSample> samples_;  // in order of time
  sync::Nanoseconds span_ = kSpan;
};

// The pose of the head at t, extrapolated with its velocity for at most kMaxHeadExtrapolation, and its status.
inline constexpr sync::Nanoseconds kMaxHeadExtrapolation{50'000'000};  // design: the largest useful frame_lag
sync::Sample<sync::BodyPose> extrapolate(const HeadSample& sample, RoomTime t);

}  // namespace tactus::visual
