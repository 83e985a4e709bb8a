// Selects the recorded messages that a replay sends, and their channels. Pure.
//
// A replay replaces the missing nodes: the simulation, and modalities that are not live. It therefore sends the state of the
// world, and the messages of modalities about themselves, unless they are live. It never sends messages that receivers would
// mistake for the live run's: measurements (NODE_HEALTH, PRESENTED, SYNC_REPORT, DEGRADED, TAG_VALUES, MEDIA_CLOCK,
// FRAME_SHOWN), clocks (CLOCK_PROBE, CLOCK_MAP: those clocks read differently today), commands and decisions (PLAYOUT,
// DEGRADATION, SETTING, SIM_COMMAND and the like: the live run has its own), forces and temperatures for devices
// (DEVICE_FORCE, THERMAL_STATE, THERMAL_DEVICE: they were safe for another hand), and the scene, which the replay serves
// itself.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sync/log/log_reader.h"
#include "sync/text/pattern.h"

namespace tactus::sync {

struct ReplaySelectionOptions {
  bool verbatim = false;                 // every message is sent, unchanged
  bool as_recorded = false;              // the profiles that were in force are sent, too
  std::string channels = {};             // regular expression that must match the whole name; empty: all
  std::string leave_out = {};            // regular expression of channels that are not sent; empty: none
  std::string also = {};                 // regular expression of channels that are sent although they are dropped by default
  std::vector<std::string> rename = {};  // "FROM=TO"
  std::vector<std::string> live = {};    // running processes: their recorded messages are not sent
};

class ReplaySelection {
 public:
  // Throws std::runtime_error with one sentence.
  explicit ReplaySelection(const ReplaySelectionOptions& selection_options);
  // The channel to send it on; nullopt: it is not sent.
  std::optional<std::string_view> channel_of(const LogEvent& event);
  bool verbatim() const { return verbatim_; }

 private:
  struct Channel {
    bool sent = false;
    std::string name;
  };
  const Channel& decide(std::string_view recorded);

  bool verbatim_;
  bool as_recorded_;
  std::optional<Pattern> channels_, leave_out_, also_;
  std::vector<std::pair<std::string, std::string>> rename_;
  std::set<std::int32_t> live_;
  std::map<std::string, Channel, std::less<>> decided_;
  Channel scratch_;
};

}  // namespace tactus::sync
