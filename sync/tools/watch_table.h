// The table of watch: the state of every node of a running cluster. Pure.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tactus/node_health_t.hpp>
#include <tactus/sync_report_t.hpp>
#include <vector>

#include "sync/presentation/sync_report_pages.h"
#include "sync/time/time.h"

namespace tactus::sync {

class WatchTable {
 public:
  static constexpr Nanoseconds kLostAfter{500'000'000};

  void observe(const node_health_t&, HostTime arrival);
  // A page of a report; the report is shown when all its pages have arrived.
  void observe(const sync_report_t& page) {
    if (auto whole = pages_.push(page)) report_ = std::move(whole);
  }

  struct Row {
    std::string node;
    std::string state;  // "running", ..., "LOST" when it fell silent
    double rate_Hz = 0;
    std::int64_t missed_ticks = 0;
    Nanoseconds input_age{-1};  // of the oldest input with regular messages; -1: it has none
    std::string oldest_input;
    std::int64_t rendered = 0;
    std::string status_text;
    std::string profile_effect;  // measured by the node; empty: no profile degrades its modality
  };
  std::vector<Row> rows(HostTime now) const;
  bool empty() const { return nodes_.empty(); }

  // A few lines, none longer than `width`.
  std::string to_text(HostTime now, std::size_t width = 110) const;
  // One line.
  std::string to_json(HostTime now) const;

 private:
  struct Node {
    node_health_t health;
    HostTime arrival;
  };
  std::map<std::string, Node> nodes_;
  SyncReportReader pages_;
  std::optional<sync_report_t> report_;
};

}  // namespace tactus::sync
