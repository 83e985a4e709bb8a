// The ticks of a tool as the log of a run tells them: when each was, and where the hand was in it. Pure but for
// the mapping of the file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tactus/tool_state_t.hpp>

#include "haptic_node/devices/device.h"
#include "sync/log_reader.h"

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
  static constexpr sync::Nanoseconds kMostUnderWay{1'000'000'000};

  // clock: of the recorder; begin, end: of the run on it. A sender with another clock is read by arrival. Throws
  // std::runtime_error with one sentence when there is no such file.
  ToolTrack(const std::string& log, std::int32_t clock, sync::HostTime begin, sync::HostTime end);

  // From its beginning, those of this tool.
  void follow(int tool);
  // The next tick that is later than `after`; nothing: there is none.
  std::optional<RecordedTick> next(sync::HostTime after);

 private:
  std::optional<RecordedTick> tick_of(const tool_state_t& m, sync::HostTime arrival);

  sync::MappedFile file_;
  sync::LogScanner scanner_;
  std::int32_t clock_;
  sync::HostTime begin_, end_;
  int tool_ = -1;
  std::int64_t realtime_offset_ns_ = 0;
  std::int64_t incarnation_ = 0;
  sync::HostTime heard_{};  // of that
};

}  // namespace tactus::haptic
