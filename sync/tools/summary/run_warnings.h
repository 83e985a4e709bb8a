// Shortcomings of a run that are no failures: processes that were not ready when the world began, outputs that were lost, and modalities
// that presented nothing although events happened. From NODE_HEALTH and WORLD_STATE of its log. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tactus/node_health_t.hpp>
#include <vector>

#include "sync/presentation/presentation_matcher.h"
#include "sync/time/time.h"

namespace tactus::sync {

class RunWarnings {
 public:
  // The first state of a world with a later simulated time than this is not its begin: the log begins midway.
  static constexpr std::int64_t kBeginWithin_ns = 100'000'000;
  // A world without a state for this time is absent: states come at 60 Hz.
  static constexpr Nanoseconds kWorldSilent{300'000'000};
  static constexpr std::size_t kMaxNodes = 256;  // more than a cluster has
  // The beginning of a world, with the report after it: nodes report at 10 Hz.
  static constexpr Nanoseconds kBeginning{1'100'000'000};

  void observe(const node_health_t& report, HostTime now);
  // A state of the world, at this simulated time.
  void observe_world(std::int64_t sim_ns, HostTime now);

  // Ticks that each node missed in the first second of the world, a frame of a picture included; empty: the log does not hold its
  // begin. A node that started again in that second is left out.
  std::map<std::string, std::int64_t> missed_in_first_second() const;

  // One sentence each. Text of nodes: escape it for a terminal.
  std::vector<std::string> sentences(const PresentationMatcher& matcher) const;

 private:
  struct Node {
    std::string modality, reason, late_reason, output_reason;
    std::int32_t expected_events = 0;
    bool ready = false, late = false;
    std::int64_t reports = 0, without_output = 0;  // while the world was present
    std::int64_t incarnation = 0, missed = 0, missed_before = 0, missed_after = 0;  // ticks: now, at the begin of the world, 1 s later
    bool same_incarnation = true;
  };

  std::map<std::string, Node> nodes_;
  bool world_seen_ = false, begin_seen_ = false;
  HostTime last_world_{}, begin_{};
};

}  // namespace tactus::sync
