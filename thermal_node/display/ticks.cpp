#include "thermal_node/display/ticks.h"

#include <algorithm>
#include <utility>

namespace tactus::thermal {

Tick Ticks::next(sync::ContactStream& stream, sync::HostTime now, sync::HostTime newest_arrival, int tool,
                 int tool_body, sync::Nanoseconds delay) {
  Tick tick;
  tick.end = now;
  tick.begin = std::min(end_.value_or(now), now);
  end_ = now;
  const auto map = stream.map(now);
  if (!map) return tick;
  tick.map = *map;
  tick.delay = delay;
  const sync::Nanoseconds ago = kSettle + delay;
  if (stream.restarts() != restarts_) sim_end_.reset();
  restarts_ = stream.restarts();

  tick.sim_end = map->to_sim(now - ago);
  if (!sim_end_) sim_end_ = map->to_sim(tick.begin - ago);
  // The map slews; an interval that it returns for a moment has already been rendered. A larger step back is a new
  // start.
  const bool fell_back = *sim_end_ - tick.sim_end > kMaxInterval;
  tick.sim_begin = fell_back ? tick.sim_end : std::max(*sim_end_, tick.sim_end - kMaxInterval);
  tick.sim_end = std::max(tick.sim_end, tick.sim_begin);
  sim_end_ = tick.sim_end;

  const bool silent = now - newest_arrival > sync::ContactStream::kStaleAfter;
  tick.events = stream.take_events(tick.sim_end);
  if (tick.sim_end > tick.sim_begin) {
    const auto contact = stream.integral(tick.sim_begin, tick.sim_end, tool, tool_body);
    const bool commanded_gap = contact.status == sync::SampleStatus::kStale && !silent;
    if (!commanded_gap) hold(contact, tick.sim_end - tick.sim_begin);
  } else if (!silent && map->rate == 0) {  // paused: the contact of that instant
    const auto contact = stream.integral(tick.sim_end, tick.sim_end + kSettle, tool, tool_body);
    const bool is_known = contact.status != sync::SampleStatus::kNone && contact.status != sync::SampleStatus::kStale;
    if (is_known) hold(contact, kSettle);
  }
  tick.contact = contact_;
  tick.contact_interval = contact_interval_;
  if (silent && tick.sim_end <= tick.sim_begin) tick.contact.status = sync::SampleStatus::kStale;
  return tick;
}

void Ticks::hold(sync::ContactIntegral contact, sync::Nanoseconds interval) {
  contact_ = std::move(contact);
  contact_interval_ = interval;
}

}  // namespace tactus::thermal
