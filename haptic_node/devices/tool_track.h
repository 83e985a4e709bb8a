// The ticks of a tool in the log of a run: the time of each and the state of the hand. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <tactus/header_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "haptic_node/devices/device.h"
#include "sync/log/log_feed.h"
#include "sync/clocks/sim_clock_tracker.h"
#include "sync/clocks/single_sender.h"

namespace tactus::haptic {

struct RecordedTick {
  sync::HostTime at{};            // on the clock of the recorder
  std::int64_t published_ns = 0;  // publish time of its TOOL_STATE, on the clock of its sender
  std::int64_t seq = 0;
  DeviceState device;
};

class ToolTrack {
 public:
  // A TOOL_STATE that arrived at the recorder further than this before or after its publish time is invalid.
  static constexpr sync::Nanoseconds kMaxTransit{1'000'000'000};

  // Maximum duration of a tick: an earlier beginning is not plausible.
  static constexpr sync::Nanoseconds kMaxTickDuration{1'000'000};

  // When the clock of the sender differs from that of the recorder, a tick has its arrival time. feed: outlives
  // this.
  explicit ToolTrack(const sync::LogFeed& feed) : feed_(feed) {}

  // Starts at the beginning of the log, for this tool.
  void follow(int tool);
  // The next tick later than `after`; empty: none.
  std::optional<RecordedTick> next(sync::HostTime after);

 private:
  std::optional<RecordedTick> tick_of(const tool_state_t& m, sync::HostTime arrival);
  sync::HostTime tick_start(const header_t& header) const;

  sync::OwnClock own() const { return {feed_.run_id(), feed_.clock(), nullptr}; }

  const sync::LogFeed& feed_;
  std::optional<sync::TimestampedEvents> events_;
  int tool_ = -1;
  sync::SimClockTracker simulation_{own()};
  sync::SingleSender sender_;  // another process of the tool counts only after its silence
};

}  // namespace tactus::haptic
