// The latency that each modality needs from an event to its earliest possible presentation, as reported so far. Pure.
//
// A modality reports the earliest possible presentation without degradation and playout delay (presentation_t.ready_ns), so
// no degradation changes a delay. A need after a stall is far beyond the budget and has no relation to the next event; a
// modality that is beyond the budget most of the time is left out.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "sync/playout/policy.h"

namespace tactus::sync {

class LatencyDemand {
 public:
  explicit LatencyDemand(const PlayoutPlan& plan) { set_plan(plan); }

  // Repeats the estimate over the stored events with the new plan.
  void set_plan(const PlayoutPlan& plan);
  // Registers a running modality, whether or not it has presented an event. slow: no other modality waits for it.
  void add_modality(const std::string& modality, bool slow = false);
  void add(const std::string& modality, Nanoseconds needed);
  // The aligner's estimate; more than the budget when most recent needs exceeded it; nullopt before the first event.
  std::optional<Nanoseconds> needed(const std::string& modality) const;
  // Latencies of all registered modalities, for playout_delays; 0 for those that have presented no event yet.
  std::map<std::string, Nanoseconds> latencies() const;
  const std::set<std::string>& slow() const { return slow_; }

 private:
  static constexpr std::size_t kMaxModalities = 64;
  static constexpr std::size_t kRemembered = 128;  // events
  static constexpr std::size_t kRecent = 16;       // events
  struct Modality {
    std::unique_ptr<Aligner> aligner;
    std::deque<Nanoseconds> last;
  };
  Modality* find_or_add(const std::string& modality);
  bool is_usable(Nanoseconds needed) const;

  PlayoutPlan plan_;
  std::map<std::string, Modality> modalities_;
  std::set<std::string> slow_;
};

}  // namespace tactus::sync
