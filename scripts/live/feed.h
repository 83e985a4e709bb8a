// The common content of all pages, collected from the messages of the bus or of a log: health of the nodes, the report of
// sync_node, and events with their outcomes in each modality. Pure; bounded for any input.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tactus/contact_events_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/modality_report_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/pair_report_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/sync_report_t.hpp>
#include <tuple>

#include "sync/bus/recent_map.h"
#include "sync/time/time.h"

namespace tactus::live {

class Feed {
 public:
  // Number of remembered events; events of one frame beyond kMaxPerFrame are left out and counted.
  static constexpr std::size_t kMaxStoredEvents = 4096;
  static constexpr std::size_t kMaxPerFrame = 400;
  static constexpr std::size_t kMaxNodes = 64, kMaxModalities = 32;

  // run_id: accepts only messages of this run; 0: of any run, as in a log.
  explicit Feed(std::int64_t run_id) : run_id_(run_id) {}

  // True for channels that are used here.
  static bool accepts(std::string_view channel);
  void on_message(std::string_view channel, std::span<const std::uint8_t> bytes, sync::HostTime arrival);
  // Call it when the log position has changed.
  void clear();

  // The changes since the last call, for every page; {} when there are none.
  nlohmann::json take_changes(sync::HostTime now);
  // The complete state for a new page: all nodes and the newest report.
  nlohmann::json state(sync::HostTime now) const;
  // The node with this header.source; "": unknown.
  std::string node_of(std::int32_t source) const;

 private:
  struct Node {
    node_health_t health;
    sync::HostTime arrival;
  };
  bool is_own_run(const header_t& header) const { return run_id_ == 0 || header.run_id == run_id_; }
  void on_message(const node_health_t& m, sync::HostTime arrival);
  void on_message(const contact_events_t& m);
  void on_message(const presented_t& m);
  void on_message(const sync_report_t& m);
  nlohmann::json health(sync::HostTime now) const;
  nlohmann::json report() const;

  std::int64_t run_id_;
  std::map<std::string, Node> nodes_;
  std::map<std::string, modality_report_t> modalities_;
  std::map<std::pair<std::string, std::string>, pair_report_t> pairs_;
  sync::RecentMap<std::int64_t, std::int64_t> event_host_ns_{kMaxStoredEvents};  // by event_id
  std::int32_t event_clock_ = 0;
  sync::RecentMap<std::tuple<std::int64_t, std::string, int>, bool> presented_{kMaxStoredEvents};
  nlohmann::json events_ = nlohmann::json::array(), presentations_ = nlohmann::json::array();
  std::int64_t dropped_events_ = 0;
  bool report_new_ = false;
  std::optional<sync::HostTime> last_health_;
};

}  // namespace tactus::live
