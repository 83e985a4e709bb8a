// Renders a recorded run (--log) instead of the bus and the device. The device is where the log recorded it, the
// ticks are those of the run, and the rendered force is written to a table, so that each row can be compared with
// the recorded force.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tactus/tool_state_t.hpp>

#include "haptic_node/devices/recorded_hand.h"
#include "haptic_node/devices/tool_track.h"
#include "sync/node/offline.h"

namespace tactus::haptic {

struct OfflineOptions : sync::OfflineOptions {
  std::string trace;  // path of the CSV table

  void add_to(CLI::App& app);
};

// All times are times of the log, except `clock`, which is this host's clock.
class Offline {
 public:
  // Throws std::runtime_error with one sentence when the log holds no run or the table cannot be written.
  Offline(const OfflineOptions& options, double rate_Hz, sync::HostTime clock);

  // Like the constructor when --log is given; returns null otherwise.
  static std::unique_ptr<Offline> open(const OfflineOptions& options, double rate_Hz, sync::HostTime clock);

  sync::OfflineInput& run() { return run_; }
  // Call it after a scene is loaded. Uses the ticks of this tool from now on; -1: no tool.
  void follow(int tool);
  std::unique_ptr<Device> device() const { return std::make_unique<RecordedHand>(tick_.device); }
  // Call once per tick. True when the tick is one of the run; false for the tick in which a scene is loaded.
  bool begin_tick(sync::HostTime now);
  // Adds the state of this tick to the table.
  void add(const tool_state_t& state);
  // Renames the table to its final name and returns a summary in lines. Throws std::runtime_error with one
  // sentence when the log has no tick of the tool; problem: the reason, if it is known.
  std::string result(const std::string& problem, sync::HostTime clock);

 private:
  void schedule();

  sync::OfflineInput run_;
  sync::AtomicFile trace_;
  ToolTrack track_;
  bool has_tool_ = false;
  RecordedTick tick_;
  std::optional<RecordedTick> next_tick_;
  std::optional<sync::HostTime> first_;
  std::int64_t rows_ = 0;
};

}  // namespace tactus::haptic
