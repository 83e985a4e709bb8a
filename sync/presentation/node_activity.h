// The times at which a process was running, according to its NODE_HEALTH. Pure.
#pragma once

#include <cstdint>
#include <deque>

#include "sync/time/time.h"

namespace tactus::sync {

class NodeActivity {
 public:
  // A silence of more than kStall within an incarnation is a stall; a silence of more than kDeath that has not ended is a
  // death.
  static constexpr Nanoseconds kStall{300'000'000};
  static constexpr Nanoseconds kDeath{500'000'000};
  // Time from a node's first report that it runs until presentations are expected of it: its subscriptions and its clock map
  // have to settle. Of a node that was ready before the world began, or reports that it has no output, they are expected from
  // then on.
  static constexpr Nanoseconds kGrace{200'000'000};
  // Length of the stored history.
  static constexpr Nanoseconds kRemember{10'000'000'000};

  enum class State {
    kAbsent,     // it did not run yet
    kAlive,      // it reported health throughout
    kStalled,    // it stopped publishing and resumed
    kDead,       // it was gone, replaced, not yet running again, or reported that it has no output
    // Its last report is before the end of the interval, but not old enough for a death.
    kUndecided,
  };
  struct Result {
    State state = State::kAbsent;
    // It is silent now: kDead becomes kStalled if the same incarnation publishes again.
    bool may_return = false;
  };

  // sent: on our clock. Returns true when the same incarnation publishes again after a stall.
  bool observe(std::int64_t incarnation, std::int8_t state, HostTime sent);

  Result during(HostTime from, HostTime to, HostTime now) const;
  // True when the last report of this incarnation is before `until` and none can follow: another incarnation has replaced it,
  // or it has been silent for too long.
  bool died_before(std::int64_t incarnation, HostTime until, HostTime now) const;

  // True when another incarnation had replaced this one by `until`.
  bool replaced_before(std::int64_t incarnation, HostTime until) const;

  // True when the last report is before `since` and the process has been silent for too long.
  bool silent_since(HostTime since, HostTime now) const {
    return !spans_.empty() && spans_.back().end < since && now - spans_.back().end > kDeath;
  }

 private:
  // Uninterrupted health of one incarnation in one ability.
  struct Span {
    std::int64_t incarnation = 0;
    bool has_output = false;  // neither waiting for its first input nor without output
    HostTime expected_from = HostTime::max();
    HostTime begin{};
    HostTime end{};
  };
  std::deque<Span> spans_;
  HostTime first_expected_from_ = HostTime::max();
};

}  // namespace tactus::sync
