#include "visual_node/frame/room_clock_reader.h"

#include <algorithm>

namespace tactus::visual {

void RoomClockReader::on_message(const header_t& header, const sim_clock_t& clock, sync::HostTime arrival) {
  switch (tracker_.track(header, clock, arrival)) {
    case sync::TrackResult::kIgnore: return;
    case sync::TrackResult::kRestart:
      maps_.clear();
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
  const auto at = std::upper_bound(maps_.begin(), maps_.end(), sent,
                                   [](RoomTime t, const PublishedMap& map) { return t < map.sent; });
  // The pages of one step carry the same map: the first of them counts.
  const auto same = [&](const sim_clock_t& known) {
    return known.sim_ns == clock.sim_ns && known.host_ns == clock.host_ns && known.rate == clock.rate;
  };
  if (at != maps_.begin() && same(std::prev(at)->clock)) return;
  maps_.insert(at, {sent, clock});
  if (maps_.size() > kMaps) maps_.pop_front();
}

bool RoomClockReader::mapped(sync::HostTime now) const {
  const auto source = sender_.read(last_.publish_time_ns, now).source;
  return source == sync::SenderClock::ClockSource::kSame || source == sync::SenderClock::ClockSource::kMapped;
}

sync::HostTime RoomClockReader::to_host(RoomTime t, sync::HostTime now) const {
  return sender_.to_host(sync::to_ns(t), now);
}

// Clocks drift relative to each other by at most 1e-4, so each round leaves that share of the difference: 3 ns of a
// year.
RoomTime RoomClockReader::to_room(sync::HostTime t, sync::HostTime now) const {
  RoomTime guess = room_time(last_.publish_time_ns);
  for (int round = 0; round < 4; ++round) guess += t - to_host(guess, now);
  return guess;
}

RoomTime RoomClockReader::sent(const header_t& h, sync::HostTime arrival) const {
  if (h.run_id == last_.run_id) {
    if (h.clock == last_.clock) return room_time(h.publish_time_ns);
    if (own_.maps != nullptr && h.run_id == own_.run_id)
      if (const auto read = own_.maps->read(sync::host_time(h.publish_time_ns), h.clock, last_.clock))
        return room_time(sync::to_ns(read->time));
  }
  return to_room(arrival, arrival);
}

sim_clock_t RoomClockReader::published_by(RoomTime t) const {
  const auto after =
      std::upper_bound(maps_.begin(), maps_.end(), t, [](RoomTime x, const PublishedMap& map) { return x < map.sent; });
  return after == maps_.begin() ? maps_.front().clock : std::prev(after)->clock;
}

}  // namespace tactus::visual
