// Accepts the states of one driver and rejects contradictory ones: two programs that send at the same time, poses that
// jump, stamps that are ahead of the clock or fall back, values that are not finite. Each contradiction loses the
// device for a while, is counted and is named. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <tactus/device_state_t.hpp>

#include "sync/clocks/sender_clock.h"
#include "sync/time/time.h"

namespace tactus::haptic {

enum class StateFault { kTwoDrivers, kTwoCommanders, kJump, kAhead, kOld, kInvalid };

class StateStream {
 public:
  // Faster than any hand: a pose that jumps faster contradicts the previous one (design: twice the highest speed
  // of a hand in a device).
  static constexpr double kMaxSpeed_m_s = 20;
  // A state whose stamp lies further beyond its arrival is ahead of the clock, on a clock that is known. On another
  // clock the silence of a lost device is allowed, because the first states may have been late by as much.
  static constexpr sync::Nanoseconds kAheadTolerance{1'000'000};
  // A driver that names no clock (0) and whose first stamp lies less than this before its arrival has the clock of this
  // host. CLOCK_MONOTONIC counts from the start of a host, so those of two hosts agree by chance only.
  static constexpr sync::Nanoseconds kPlausibleTransit{100'000'000};

  enum class Result { kRejected, kAccepted, kRestarted };  // kRestarted: accepted, the first one of a stream

  // stale_after: silence after which another driver, or an earlier stamp, is accepted. unknown_delay: transit assumed
  // for a driver whose clock is not known, in addition to the measured variation.
  StateStream(sync::Nanoseconds stale_after, sync::Nanoseconds unknown_delay)
      : stale_after_(stale_after), unknown_delay_(unknown_delay) {}
  void set_clock(const sync::OwnClock& own) { own_ = own; }

  Result add(const device_state_t& state, sync::HostTime arrival);
  void report(StateFault fault, sync::HostTime at);

  // The newest accepted state; null: none.
  const device_state_t* newest() const { return newest_ ? &*newest_ : nullptr; }
  // Transit of the newest accepted state, s, >= 0.
  double transit_s() const { return transit_s_; }
  bool silent(sync::HostTime now) const { return !newest_ || now - newest_arrival_ > stale_after_; }
  // The contradiction of less than stale_after ago; empty: none.
  std::optional<StateFault> fault(sync::HostTime now) const;
  std::int64_t count(StateFault fault) const { return counts_[static_cast<std::size_t>(fault)]; }
  // States that repeat an earlier one; they are ignored and do not count as an answer.
  std::int64_t repeated() const { return repeated_; }

  // A phrase after the name of the device, such as "sends states that are dated ahead of the clock (3 so far)".
  std::string describe(StateFault fault) const;

 private:
  struct Seen {
    std::int64_t publish_ns = -1, seq = -1;
    double x = 0, y = 0, z = 0;
    bool operator==(const Seen&) const = default;
  };
  static Seen seen(const device_state_t& state);
  bool repetition(const device_state_t& state) const;
  bool measure_transit(const device_state_t& state, sync::HostTime arrival, bool restart);
  bool jumps(const device_state_t& state) const;

  sync::Nanoseconds stale_after_, unknown_delay_;
  sync::OwnClock own_{0};
  sync::SenderClock sender_{own_};
  bool own_clock_ = false;  // the driver names no clock, and has that of this host
  double transit_s_ = 0;
  std::optional<device_state_t> newest_;
  sync::HostTime newest_arrival_{};
  std::array<Seen, 64> seen_{};
  std::size_t next_seen_ = 0;
  std::optional<StateFault> last_fault_;
  sync::HostTime last_fault_at_{};
  std::array<std::int64_t, 6> counts_{};
  std::int64_t repeated_ = 0;
};

}  // namespace tactus::haptic
