// A recorded run in place of bus and device: the node renders the log, its hand is where the log says that it was, and
// what it feels goes into a table. Its ticks are those of the run, so that row by row the force can be
// held against the one that was felt.
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
  std::string trace;  // CSV

  void add_to(CLI::App& app);
};

// All times but `clock`, that of whoever looks on, are the log's.
class Offline {
 public:
  // Throws std::runtime_error with one sentence when the log holds no run or the table cannot be written.
  Offline(const OfflineOptions& options, double rate_Hz, sync::HostTime clock);

  // The same where a log is asked for; else null.
  static std::unique_ptr<Offline> open(const OfflineOptions& options, double rate_Hz, sync::HostTime clock);

  sync::Offline& run() { return run_; }
  // A scene has come: its ticks are those of this tool from now on; -1: of none.
  void follow(int tool);
  std::unique_ptr<Device> device() const { return std::make_unique<RecordedHand>(tick_.device); }
  // Once a tick. True when it is one of the run: the tick in which a scene comes is none.
  bool begin_tick(sync::HostTime now);
  // What the hand feels in this tick.
  void add(const tool_state_t& state);
  // The table gets its name. What came of it, in lines. Throws std::runtime_error with one sentence when nobody
  // held the tool; problem: why there is none.
  std::string result(const std::string& problem, sync::HostTime clock);

 private:
  void schedule();

  sync::Offline run_;
  sync::AtomicFile trace_;
  ToolTrack track_;
  bool follows_ = false;
  RecordedTick tick_;
  std::optional<RecordedTick> coming_;
  std::optional<sync::HostTime> first_;
  std::int64_t rows_ = 0;
};

}  // namespace tactus::haptic
