// The presentation delay of one modality, which follows the delay that sync_node publishes: slewed, never stepped. Pure.
#pragma once

#include <optional>
#include <string>
#include <tactus/playout_t.hpp>
#include <utility>

#include "sync/time/time.h"

namespace tactus::sync {

class PlayoutFollower {
 public:
  // Maximum change of the delay as a share of elapsed time. design: a rhythm is stretched by at most 5 %
  static constexpr double kSlew = 0.05;

  explicit PlayoutFollower(std::string modality) : modality_(std::move(modality)) {}

  // The delay to use while no PLAYOUT message sets one.
  void set_own(Nanoseconds delay) {
    own_ = delay;
    if (!published_) delay_ = delay;
  }
  // Takes the entry of this modality, which arrived at `at`; other entries are ignored. The delay follows it from then on, and not only
  // from the next tick on.
  void push(const playout_t& m, HostTime at);
  // Once a tick. Returns the delay in force.
  Nanoseconds step(HostTime now);
  Nanoseconds delay() const { return delay_; }
  // The delay at a later time, if no other delay is published until then.
  Nanoseconds delay_at(HostTime later) const;
  // The time at which the output shows what happened at `happened`, when `added` is added to the delay: the same for each tick that
  // asks, also while the delay changes.
  HostTime presentation_of(HostTime happened, Nanoseconds added) const;
  // True under the policy ASAP: the delay is 0, and a later presentation is intended.
  bool as_soon_as_possible() const { return policy_ == playout_t::ASAP && published_; }
  // Rate of the lock-step with the other modalities, Hz; 0: none.
  double lockstep_Hz() const { return lockstep_Hz_; }

 private:
  std::string modality_;
  Nanoseconds own_{0}, delay_{0};
  std::optional<Nanoseconds> published_;
  std::optional<HostTime> last_;
  double lockstep_Hz_ = 0;
  std::int8_t policy_ = playout_t::LOCAL_HAPTIC_FIRST;
};

}  // namespace tactus::sync
