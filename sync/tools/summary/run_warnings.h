// Shortcomings of a run that are no failures: processes that were not ready when the world began, outputs that were lost, and modalities
// that presented nothing although events happened. From NODE_HEALTH and WORLD_STATE of its log. Pure.
#pragma once

#include <array>
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
  // Seconds at the begin of a world whose missed ticks are counted apart.
  static constexpr std::size_t kSeconds = 3;
  // Time to the report after a second: nodes report at 10 Hz.
  static constexpr Nanoseconds kReport{100'000'000};

  void observe(const node_health_t& report, HostTime now);
  // A state of the world, at this simulated time.
  void observe_world(std::int64_t sim_ns, HostTime now);

  // Ticks that each node missed in the first seconds of the world, a frame of a picture included: the first second, and the next ones up to
  // kSeconds that the log holds whole. Empty: the log does not hold the begin of the world. The seconds from that in which a node started again
  // are left out.
  std::map<std::string, std::vector<std::int64_t>> missed_by_second() const;

  // One sentence each. Text of nodes: escape it for a terminal.
  std::vector<std::string> sentences(const PresentationMatcher& matcher) const;

 private:
  struct Node {
    std::string modality, reason, late_reason, output_reason;
    std::int32_t expected_events = 0;
    bool ready = false, late = false;
    std::int64_t reports = 0, without_output = 0;  // while the world was present
    std::int64_t incarnation = 0, missed = 0;
    std::array<std::int64_t, kSeconds + 1> missed_at{};  // at the begin of the world, and 1 s, 2 s, ... later
    std::size_t seconds = kSeconds;                      // in one incarnation
    HostTime last{};
  };

  void count_missed(Node& node, const node_health_t& report, bool first, HostTime now);

  std::map<std::string, Node> nodes_;
  bool world_seen_ = false, begin_seen_ = false;
  HostTime last_world_{}, begin_{};
};

}  // namespace tactus::sync
