// What each sense needs from an event to its earliest possible presentation, as heard so far. Pure.
//
// A sense is asked how late it could have been with nothing degraded and no playout delay
// (presentation_t.ready_ns): so no degradation moves a delay. What comes after a stall is far beyond the budget
// and says nothing of the next event; a sense that is beyond it most of the time is left out.
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

  // The last events are estimated anew.
  void set_plan(const PlayoutPlan& plan);
  // A sense is there, whether it has presented anything or not. slow: no other waits for it.
  void know(const std::string& modality, bool slow = false);
  void add(const std::string& modality, Nanoseconds needed);
  // By the aligner; more than the budget when most lately were; none before the first event.
  std::optional<Nanoseconds> needed(const std::string& modality) const;
  // Of all senses that are there, for playout_delays: 0 for those that have presented nothing yet.
  std::map<std::string, Nanoseconds> all() const;
  const std::set<std::string>& slow() const { return slow_; }

 private:
  static constexpr std::size_t kMaxSenses = 64;
  static constexpr std::size_t kRemembered = 128;  // events
  static constexpr std::size_t kLately = 16;       // events
  struct ModalityEndpoint {
    std::unique_ptr<Aligner> aligner;
    std::deque<Nanoseconds> last;
  };
  ModalityEndpoint* of(const std::string& modality);
  bool counts(Nanoseconds needed) const;

  PlayoutPlan plan_;
  std::map<std::string, ModalityEndpoint> senses_;
  std::set<std::string> slow_;
};

}  // namespace tactus::sync
