// The presentation delay of one sense as it follows what sync_node asks for: slewed, never stepped. Pure.
#pragma once

#include <optional>
#include <string>
#include <tactus/playout_t.hpp>
#include <utility>

#include "sync/time/time.h"

namespace tactus::sync {

class PlayoutFollower {
 public:
  // A delay changes by at most so much of the time that passes. design: a rhythm is stretched by no more than 5 %
  static constexpr double kSlew = 0.05;

  explicit PlayoutFollower(std::string modality) : modality_(std::move(modality)) {}

  // Until somebody says otherwise.
  void set_own(Nanoseconds delay) {
    own_ = delay;
    if (!told_) delay_ = delay;
  }
  // What concerns this sense; other senses' delays are ignored.
  void take(const playout_t& m);
  // Once a tick. Returns the delay in force.
  Nanoseconds step(HostTime now);
  Nanoseconds delay() const { return delay_; }
  // The policy is ASAP: the delay is 0, and what comes too late for it is meant to.
  bool as_soon_as_possible() const { return policy_ == playout_t::ASAP && told_; }
  // Rate of a lock-step with the other senses, Hz; 0: none.
  double lockstep_Hz() const { return lockstep_Hz_; }

 private:
  std::string modality_;
  Nanoseconds own_{0}, delay_{0};
  std::optional<Nanoseconds> told_;
  std::optional<HostTime> last_;
  double lockstep_Hz_ = 0;
  std::int8_t policy_ = playout_t::LOCAL_HAPTIC_FIRST;
};

}  // namespace tactus::sync
