// Which recorded messages a replay sends, and on which channel. Pure.
//
// A replay stands in for what is not there: the simulation, and senses that are not live. So what the world said
// goes out, and what senses said of themselves, unless they are live. What does not go out, whoever said it, is
// what would be mistaken for the live run: measurements (NODE_HEALTH, PRESENTED, SYNC_REPORT, DEGRADED,
// TAG_VALUES, MEDIA_CLOCK, FRAME_SHOWN), clocks (CLOCK_PROBE, CLOCK_MAP: of clocks that read otherwise today),
// orders and decisions (PLAYOUT, DEGRADATION, SETTING, SIM_COMMAND and their like: the live run has its own),
// forces and temperatures for devices (DEVICE_FORCE, THERMAL_STATE, THERMAL_DEVICE: they were safe for another
// hand), and what the replay serves itself (the scene).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sync/log/log_reader.h"

namespace tactus::sync {

struct ReplayWishes {
  bool verbatim = false;                 // everything goes out, as it is
  bool as_recorded = false;              // the profiles that were in force too
  std::string channels = {};             // regular expression that the whole name matches; empty: all
  std::string leave_out = {};            // likewise; empty: none
  std::string also = {};                 // likewise: goes out although it would not
  std::vector<std::string> rename = {};  // "FROM=TO"
  std::vector<std::string> live = {};    // processes that run: what they said then does not go out
};

class ReplayChoice {
 public:
  // Throws std::runtime_error with one sentence.
  explicit ReplayChoice(const ReplayWishes& wishes);
  // The channel to send it on; nothing: it stays in the log.
  std::optional<std::string_view> channel_of(const LogEvent& event);
  bool verbatim() const { return verbatim_; }

 private:
  struct Channel {
    bool goes = false;
    std::string name;
  };
  const Channel& decide(std::string_view recorded);

  bool verbatim_;
  bool as_recorded_;
  std::optional<std::regex> channels_, leave_out_, also_;
  std::vector<std::pair<std::string, std::string>> rename_;
  std::set<std::int32_t> live_;
  std::map<std::string, Channel, std::less<>> decided_;
  Channel scratch_;
};

}  // namespace tactus::sync
