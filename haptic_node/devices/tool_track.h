// The ticks of a tool as the log of a run tells them: when each was, and where the hand was in it. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <tactus/header_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "haptic_node/devices/device.h"
#include "sync/log/log_feed.h"
#include "sync/clocks/sim_clock_tracker.h"

namespace tactus::haptic {

struct RecordedTick {
  sync::HostTime at{};            // on the recorder's clock
  std::int64_t published_ns = 0;  // as its TOOL_STATE says, on the clock of its sender
  std::int64_t seq = 0;
  DeviceState device;
};

class ToolTrack {
 public:
  // Another process of the same tool is heard only when the one before has been silent for so long.
  static constexpr sync::Nanoseconds kSilence{300'000'000};
  // A TOOL_STATE that arrived at the recorder so much before or after it says to have been sent is damaged.
  static constexpr sync::Nanoseconds kMaxUnderWay{1'000'000'000};

  // A tick takes no longer: what says that it began earlier before it was told of is not its beginning.
  static constexpr sync::Nanoseconds kLongestTick{1'000'000};

  // A sender with another clock than the recorder's is read by arrival. feed: outlives this.
  explicit ToolTrack(const sync::LogFeed& feed) : feed_(feed) {}

  // From its beginning, those of this tool.
  void follow(int tool);
  // The next tick that is later than `after`; nothing: there is none.
  std::optional<RecordedTick> next(sync::HostTime after);

 private:
  std::optional<RecordedTick> tick_of(const tool_state_t& m, sync::HostTime arrival);
  sync::HostTime began(const header_t& header) const;

  sync::OwnClock own() const { return {feed_.run_id(), feed_.clock(), nullptr}; }

  const sync::LogFeed& feed_;
  std::optional<sync::TimestampedEvents> events_;
  int tool_ = -1;
  sync::SimClockTracker simulation_{own()};
  std::int64_t incarnation_ = 0;
  sync::HostTime heard_{};  // of that
};

}  // namespace tactus::haptic
