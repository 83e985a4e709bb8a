// Decides when each sense presents, and says so: the heart of PLAYOUT. Of several hosts' sync_nodes the one with
// the lowest clock speaks; the others listen and know what to say should it fall silent. Pure.
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
  // Who was not heard for so long speaks no more.
  static constexpr Nanoseconds kSilent{1'000'000'000};
  // A delay stays while what is needed falls by less: a small constant delay is better than jitter.
  static constexpr Nanoseconds kSlack{3'000'000};

  static constexpr double kLockstepSlack = 0.15;  // design: three times the slew of a delay

  // own_clock: header_t.clock of this process.
  PlayoutCoordinator(std::int64_t own_clock, PlayoutPlan plan);

  // Somebody asks for another plan. False: it is older than what is in force, or no plan.
  bool take(const playout_request_t& m);
  // What another sync_node says; its own is ignored.
  void take(const playout_t& m, HostTime now);
  LatencyDemand& needs() { return needs_; }

  // What to publish now, ten times a second; nothing while another speaks.
  std::optional<playout_t> due(HostTime now);
  const PlayoutPlan& plan() const { return plan_; }

 private:
  void put_in_force(std::int64_t generation, PlayoutPlan plan);
  Nanoseconds settled(const std::string& modality, Nanoseconds delay);

  std::int64_t own_clock_;
  PlayoutPlan plan_;
  std::int64_t generation_ = 0;
  LatencyDemand needs_;
  std::map<std::string, Nanoseconds> said_;
  double lockstep_Hz_ = 0;
  std::optional<HostTime> heard_;  // of a lower clock
  HostTime next_{};
};

}  // namespace tactus::sync
