// When a process was there, as far as its NODE_HEALTH tells. Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <tactus/node_health_t.hpp>

#include "sync/time/time.h"

namespace tactus::sync {

class NodeLife {
 public:
  // A silence of more than this within an incarnation is a stall; one of more than this and not yet ended, a
  // death.
  static constexpr Nanoseconds kStall{300'000'000};
  static constexpr Nanoseconds kDeath{500'000'000};
  // From its first report that it runs, a node has so long until it owes anything: its subscriptions and its map
  // between the clocks have to settle. One that was ready before the world began owes from then on.
  static constexpr Nanoseconds kGrace{200'000'000};
  // How far back questions can be asked.
  static constexpr Nanoseconds kRemember{10'000'000'000};

  enum class Fate {
    kAbsent,     // it had not begun to run by then
    kAlive,      // it reported health throughout
    kStalled,    // it fell silent and came back
    kDead,       // it was gone, replaced, not yet running again, or said itself that it has no output
    kUndecided,  // it reported health last before the end of the interval, and not long enough ago to be called
                 // dead
  };
  struct Answer {
    Fate fate = Fate::kAbsent;
    // It is silent now: kDead becomes kStalled if the same incarnation speaks again.
    bool may_return = false;
  };

  // sent: on our clock. Returns true when the same incarnation speaks again after a stall.
  bool observe(std::int64_t incarnation, std::int8_t state, HostTime sent);

  Answer during(HostTime from, HostTime to, HostTime now) const;
  // True when this incarnation spoke last before `until` and never will again: another took its place, or it has
  // been silent for too long.
  bool died_before(std::int64_t incarnation, HostTime until, HostTime now) const;

  // True when it spoke last before `since` and has been silent for too long.
  bool silent_since(HostTime since, HostTime now) const {
    return !spans_.empty() && spans_.back().end < since && now - spans_.back().end > kDeath;
  }

 private:
  // Uninterrupted health of one incarnation in one ability.
  struct Span {
    std::int64_t incarnation = 0;
    bool able = false;  // neither waiting for its first input nor without output
    HostTime owes_from = HostTime::max();
    HostTime begin{};
    HostTime end{};
  };
  std::deque<Span> spans_;
  HostTime first_owes_from_ = HostTime::max();
};

}  // namespace tactus::sync
