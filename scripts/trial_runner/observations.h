// Converts received messages to the output of the trial runner, one JSON object per line. Times are host times of its own clock,
// ns. Pure.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tactus/contact_events_t.hpp>
#include <tactus/game_state_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/media_clock_t.hpp>
#include <tactus/picture_chunk_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <vector>

#include "sync/clocks/clock_maps.h"
#include "sync/tools/picture_reader.h"
#include "sync/clocks/sender_clock.h"

namespace tactus::trial_runner {

class Observations {
 public:
  // Number of remembered event ids, so that each event is written once.
  static constexpr std::size_t kMaxStoredIds = 4096;
  static constexpr std::size_t kMaxSenders = 256;

  explicit Observations(sync::OwnClock own) : own_(own) {}

  // {"event": id as text, "kind": "begin" | "hit" | "end", "tool": , "sim_ns": , "speed_m_s": }, each event once.
  std::vector<nlohmann::json> push(const contact_events_t& m);
  // {"presented": id as text, "modality": , "part": , "outcome": , "at_ns": null when it was not presented or the time is
  // unknown, "scheduled_ns": , "uncertainty_ns": of the report plus the clock map}, each once.
  std::vector<nlohmann::json> push(const presented_t& m, sync::HostTime arrival);
  // {"medium": , "index": , "at_ns": , "reason": }
  std::optional<nlohmann::json> push(const media_clock_t& m, sync::HostTime arrival);
  // {"game": {"won": , "won_sim_ns": , "filled": , "wrong": }}, when it has changed.
  std::optional<nlohmann::json> push(const game_state_t& m);
  // {"picture": number, "sim_ns": , "at_ns": time of its presentation, null when unknown, "jpeg": base64}, of a complete
  // picture.
  std::optional<nlohmann::json> push(const picture_chunk_t& m, sync::HostTime arrival);
  // {"pulse": {"tool": , "at_ns": , "force_N": }} of the first tick in which a hit vibrates in the hand.
  std::optional<nlohmann::json> push(const tool_state_t& m, sync::HostTime arrival);

 private:
  bool is_first(std::set<std::vector<std::int64_t>>& known, std::vector<std::int64_t> key);
  sync::SenderClock* clock_of(const header_t& header, sync::HostTime arrival);

  sync::OwnClock own_;
  std::set<std::vector<std::int64_t>> events_, reports_;
  std::map<std::int32_t, sync::SenderClock> clocks_;  // by source
  std::string game_;
  sync::PictureReader pictures_;
  std::map<std::int32_t, bool> vibrates_;  // by source
};

}  // namespace tactus::trial_runner
