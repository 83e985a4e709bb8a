// The processes of this run, from NODE_HEALTH: new ones, and another simulation. Messages of other runs are ignored. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tactus/node_health_t.hpp>

#include "sync/bus/recent_map.h"
#include "sync/time/time.h"

namespace tactus::sim {

class KnownProcesses {
 public:
  // More processes than a cluster has; the oldest is removed, and counts as new when it reports again.
  static constexpr std::size_t kMax = 1024;
  // A simulation without a report for this time has ended: ten reports at 10 Hz.
  static constexpr sync::Nanoseconds kSilence{1'000'000'000};

  // name: of this simulation on the bus. run_id: of its run.
  KnownProcesses(std::string name, std::int64_t run_id) : name_(std::move(name)), run_id_(run_id) {}

  // Call with each incarnation of this simulation before it reports.
  void add_own(std::int64_t incarnation) { own_.try_emplace(incarnation); }
  // Stores a report. Returns true for the first one of another process of this run.
  bool is_new(const node_health_t& report, sync::HostTime arrival);
  // One sentence; empty: no other simulation of this run reports.
  std::string conflict_text(sync::HostTime now) const;

 private:
  struct Nothing {};
  std::string name_;
  std::int64_t run_id_;
  sync::RecentMap<std::int64_t, Nothing> own_{16}, known_{kMax};
  std::optional<sync::HostTime> last_other_;
};

}  // namespace tactus::sim
