#include "haptic_node/devices/state_stream.h"

#include <algorithm>

#include "lcmtypes/vectors.h"

namespace tactus::haptic {
namespace {

using sync::Nanoseconds;

bool finite(const device_state_t& m) {
  const auto turn = to_eigen(m.pose.orientation).coeffs();
  return to_eigen(m.pose.position_m).allFinite() && turn.allFinite() && turn.norm() > 0 &&
         to_eigen(m.velocity_m_s).allFinite() && to_eigen(m.spin_rad_s).allFinite();
}

}  // namespace

StateStream::Seen StateStream::seen(const device_state_t& m) {
  return {m.header.publish_time_ns, m.header.seq, m.pose.position_m.x, m.pose.position_m.y, m.pose.position_m.z};
}

// Two states with one stamp: a clock may be coarse, so the second is no contradiction.
bool StateStream::repetition(const device_state_t& m) const {
  return m.header.publish_time_ns == newest_->header.publish_time_ns ||
         std::find(seen_.begin(), seen_.end(), seen(m)) != seen_.end();
}

// False when the state is dated ahead of the clock.
bool StateStream::measure_transit(const device_state_t& m, sync::HostTime arrival, bool restart) {
  const Nanoseconds since_stamp = arrival - sync::host_time(m.header.publish_time_ns);
  if (restart) {
    sender_ = sync::SenderClock(own_);
    own_clock_ = m.header.clock == 0 && since_stamp >= -kAheadTolerance && since_stamp < kPlausibleTransit;
  }
  if (!restart && !own_clock_) {
    const auto reading = sender_.read(m.header.publish_time_ns, arrival);
    const bool one_way = reading.source == sync::SenderClock::ClockSource::kOneWay;
    const Nanoseconds tolerance = one_way ? stale_after_ : kAheadTolerance + std::max(reading.uncertainty, Nanoseconds(0));
    if (reading.time - arrival > tolerance) return false;
  }
  if (own_clock_) {
    if (since_stamp < -kAheadTolerance) return false;
    transit_s_ = std::max(0.0, sync::to_seconds(since_stamp));
    return true;
  }
  sender_.observe(m.header, arrival);
  const auto reading = sender_.read(m.header.publish_time_ns, arrival);
  const bool one_way = reading.source == sync::SenderClock::ClockSource::kOneWay;
  if (!one_way && reading.time - arrival > kAheadTolerance + std::max(reading.uncertainty, Nanoseconds(0))) return false;
  transit_s_ = std::max(0.0, sync::to_seconds(arrival - reading.time + (one_way ? unknown_delay_ : Nanoseconds(0))));
  return true;
}

bool StateStream::jumps(const device_state_t& m) const {
  // Messages that queued up arrive together, so this uses the times of the sender; at least a millisecond, because its
  // clock may be coarse.
  const double passed_s =
      std::max(1e-9 * static_cast<double>(m.header.publish_time_ns - newest_->header.publish_time_ns), 1e-3);
  return (to_eigen(m.pose.position_m) - to_eigen(newest_->pose.position_m)).norm() > kMaxSpeed_m_s * passed_s;
}

StateStream::Result StateStream::add(const device_state_t& m, sync::HostTime arrival) {
  const auto reject = [&](StateFault fault) {
    report(fault, arrival);
    return Result::kRejected;
  };
  if (!finite(m)) return reject(StateFault::kInvalid);
  const bool was_silent = silent(arrival);
  const bool other = newest_ && m.header.incarnation != newest_->header.incarnation;
  if (other && !was_silent) return reject(StateFault::kTwoDrivers);
  const bool restart = other || was_silent;
  if (newest_ && !other) {
    if (repetition(m)) {
      ++repeated_;
      return Result::kRejected;
    }
    if (m.header.publish_time_ns < newest_->header.publish_time_ns) {
      report(StateFault::kOld, arrival);
      // After a silence the clock of the driver may have stepped back; it must prove itself like after any fault.
      if (!was_silent) return Result::kRejected;
    }
  }
  if (!measure_transit(m, arrival, restart)) return reject(StateFault::kAhead);
  if (!restart && jumps(m)) report(StateFault::kJump, arrival);
  newest_ = m;
  newest_arrival_ = arrival;
  seen_[next_seen_] = seen(m);
  next_seen_ = (next_seen_ + 1) % seen_.size();
  return restart ? Result::kRestarted : Result::kAccepted;
}

void StateStream::report(StateFault fault, sync::HostTime at) {
  last_fault_ = fault;
  last_fault_at_ = at;
  ++counts_[static_cast<std::size_t>(fault)];
}

std::optional<StateFault> StateStream::fault(sync::HostTime now) const {
  return last_fault_ && now - last_fault_at_ < stale_after_ ? last_fault_ : std::nullopt;
}

std::string StateStream::describe(StateFault fault) const {
  const char* text = "";
  switch (fault) {
    case StateFault::kTwoDrivers: text = "has two drivers; end one of them"; break;
    case StateFault::kTwoCommanders: text = "is commanded by two processes; end one of them"; break;
    case StateFault::kJump: text = "sends poses that jump"; break;
    case StateFault::kAhead: text = "sends states that are dated ahead of the clock"; break;
    case StateFault::kOld: text = "sends states that are older than the newest one"; break;
    case StateFault::kInvalid: text = "sends states that are not finite"; break;
  }
  return std::string(text) + " (" + std::to_string(count(fault)) + " so far)";
}

}  // namespace tactus::haptic
