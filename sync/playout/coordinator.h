// Chooses the presentation delay of each modality and publishes it as PLAYOUT. Of the sync_nodes on several hosts, the one
// with the lowest clock publishes; the others store its plan, to continue should it stop publishing. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tactus/playout_request_t.hpp>
#include <tactus/playout_t.hpp>

#include "sync/playout/latency_demand.h"

namespace tactus::sync {

class PlayoutCoordinator {
 public:
  static constexpr Nanoseconds kPeriod{100'000'000};
  // A coordinator that has not published for this time counts as stopped.
  static constexpr Nanoseconds kSilent{1'000'000'000};
  // A delay stays while the need falls by less than this: a small constant delay is better than jitter.
  static constexpr Nanoseconds kSlack{3'000'000};

  static constexpr double kLockstepSlack = 0.15;  // design: three times the slew of a delay

  // own_clock: header_t.clock of this process.
  PlayoutCoordinator(std::int64_t own_clock, PlayoutPlan plan);

  // A request for another plan. Returns false when it is older than the plan in force, or invalid.
  bool push(const playout_request_t& m);
  // A message of another sync_node; its own messages are ignored.
  void push(const playout_t& m, HostTime now);
  LatencyDemand& latency_demand() { return demand_; }

  // The message to publish now, ten times a second; nullopt while another coordinator publishes.
  std::optional<playout_t> next_message(HostTime now);
  const PlayoutPlan& plan() const { return plan_; }

 private:
  void apply_plan(std::int64_t generation, PlayoutPlan plan);
  Nanoseconds with_hysteresis(const std::string& modality, Nanoseconds delay);

  std::int64_t own_clock_;
  PlayoutPlan plan_;
  std::int64_t generation_ = 0;
  LatencyDemand demand_;
  std::map<std::string, Nanoseconds> published_;
  double lockstep_Hz_ = 0;
  std::optional<HostTime> other_published_;  // from a lower clock
  HostTime next_{};
};

}  // namespace tactus::sync
