#include "visual_node/frame/room_clock_reader.h"

#include <algorithm>

namespace tactus::visual {

void RoomClockReader::hear(const header_t& header, const sim_clock_t& clock, sync::HostTime arrival) {
  switch (follower_.follow(header, clock, arrival)) {
    case sync::TrackResult::kIgnore: return;
    case sync::TrackResult::kRestart:
      told_.clear();
      if (clocks_ == 0 || header.clock != last_.clock || header.run_id != last_.run_id ||
          header.publish_time_ns < last_.publish_time_ns) {
        ++clocks_;
        sender_ = sync::SenderClock(own_);
      }
      break;
    case sync::TrackResult::kSame: break;
  }
  sender_.observe(header, arrival);
  last_ = header;
  const RoomTime sent = room_time(header.publish_time_ns);
  const auto at = std::upper_bound(told_.begin(), told_.end(), sent,
                                   [](RoomTime t, const Told& told) { return t < told.sent; });
  // The pages of one step tell the same: the first of them counts.
  const auto same = [&](const sim_clock_t& known) {
    return known.sim_ns == clock.sim_ns && known.host_ns == clock.host_ns && known.rate == clock.rate;
  };
  if (at != told_.begin() && same(std::prev(at)->clock)) return;
  told_.insert(at, {sent, clock});
  if (told_.size() > kMaps) told_.pop_front();
}

bool RoomClockReader::mapped(sync::HostTime now) const {
  const auto status = sender_.read(last_.publish_time_ns, now).status;
  return status == sync::SenderClock::SampleStatus::kSame || status == sync::SenderClock::SampleStatus::kMapped;
}

sync::HostTime RoomClockReader::here(RoomTime t, sync::HostTime now) const {
  return sender_.to_host(sync::to_ns(t), now);
}

// Clocks drift by no more than 1e-4 of each other, so that each round leaves so much of the difference: of a year,
// 3 ns.
RoomTime RoomClockReader::room(sync::HostTime t, sync::HostTime now) const {
  RoomTime guess = room_time(last_.publish_time_ns);
  for (int round = 0; round < 4; ++round) guess += t - here(guess, now);
  return guess;
}

RoomTime RoomClockReader::sent(const header_t& h, sync::HostTime arrival) const {
  if (h.run_id == last_.run_id) {
    if (h.clock == last_.clock) return room_time(h.publish_time_ns);
    if (own_.maps != nullptr && h.run_id == own_.run_id)
      if (const auto read = own_.maps->read(sync::host_time(h.publish_time_ns), h.clock, last_.clock))
        return room_time(sync::to_ns(read->time));
  }
  return room(arrival, arrival);
}

sim_clock_t RoomClockReader::told_by(RoomTime t) const {
  const auto after =
      std::upper_bound(told_.begin(), told_.end(), t, [](RoomTime x, const Told& told) { return x < told.sent; });
  return after == told_.begin() ? told_.front().clock : std::prev(after)->clock;
}

}  // namespace tactus::visual
