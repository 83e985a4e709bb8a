// When the time of a world begins: after the scene was offered for a while, and when every awaited process has reported that
// it has its scene, from NODE_HEALTH. It never waits longer than a bound. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tactus/node_health_t.hpp>
#include <vector>

#include "sync/time/time.h"

namespace tactus::sync {

struct WorldStartDef {
  std::vector<std::string> awaited;  // processes that are awaited from the first tick on, also before their first report
  std::int64_t run_id = 0;           // reports of other runs are ignored
  Nanoseconds min_wait{0};           // the world begins not earlier than this after the first tick
  Nanoseconds max_wait{0};           // and not later than this after min_wait
};

// Also awaits each other process of the run that reports a modality: a process that was started by hand is not named.
class WorldStart {
 public:
  // More processes than a cluster has; others that are not named are not awaited.
  static constexpr std::size_t kMaxNodes = 256;

  WorldStart(WorldStartDef def, HostTime now);

  // Stores a report. The newest one of a process counts. A process is ready in every state but WAITING: one that lacks its
  // device or another input cannot become ready by more time.
  void observe(const node_health_t& report);
  // True when the world begins, with or without all awaited processes.
  bool due(HostTime now) const;
  // The processes that are not ready, each with its reason: "visual_node (prepares the pictures of the scene)"; empty: none.
  // Text of other processes: escape it for a terminal.
  std::string late() const;

 private:
  struct State {
    bool ready = false;
    std::string reason;
  };
  bool all_ready() const;

  WorldStartDef def_;
  HostTime begin_;
  std::map<std::string, State> nodes_;  // by name
};

}  // namespace tactus::sync
