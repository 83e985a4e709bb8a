// Renders a recorded run (--log) instead of the bus and the device. The device is where the log recorded it, the
// ticks are those of the run, and the rendered force is written to a table, so that each row can be compared with
// the recorded force.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tactus/tool_state_t.hpp>

#include "haptic_node/devices/recorded_hand.h"
#include "haptic_node/devices/tool_track.h"
#include "sync/node/offline.h"

namespace tactus::haptic {

// All times are times of the log, except `clock`, which is this host's clock.
class Offline : public sync::OfflineTable {
 public:
  // Throws std::runtime_error with one sentence when the log holds no run or the table cannot be written.
  Offline(const sync::OfflineTableOptions& options, double rate_Hz, sync::HostTime clock);

  // After a scene is loaded: uses the ticks of this tool from now on; -1: no tool.
  void follow(int tool);
  std::unique_ptr<Device> device() const { return std::make_unique<RecordedHand>(tick_.device); }
  // Call once per tick. True when the tick is one of the run; false for the tick in which a scene is loaded.
  bool begin_tick(sync::HostTime now);
  // Adds the state of this tick to the table.
  void add(const tool_state_t& state);
  // As sync::OfflineTable::result, also when the log has no tick of the tool; problem: the reason, if it is known.
  std::string result(const std::string& problem, sync::HostTime clock);

 private:
  void schedule();

  ToolTrack track_;
  bool has_tool_ = false;
  RecordedTick tick_;
  std::optional<RecordedTick> next_tick_;
};

}  // namespace tactus::haptic
