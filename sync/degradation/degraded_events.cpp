#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>

#include "sync/degradation/degraded_stream.h"

namespace tactus::sync {
namespace {

StreamItem item_of(const contact_event_t& e, std::int64_t incarnation, HostTime arrival) {
  return {.key = static_cast<std::uint64_t>(e.event_id),
          .is_event = true,
          .incarnation = incarnation,
          .time = sim_time(e.time_ns),
          .arrival = arrival,
          .signals = {},
          .speed_m_s = e.approach_speed_m_s,
          .body_a = e.body_a,
          .body_b = e.body_b,
          .material_a = e.material_a,
          .material_b = e.material_b};
}

}  // namespace

// Returns true once for each event: the profile decides on it now.
bool DegradedEvents::decides(std::int64_t id) {
  return !std::exchange(memory_.try_emplace(id).first.decided, true);
}

void DegradedEvents::push(const contact_events_t& m, HostTime arrival, OperatorChain& stack, Decisions* decisions) {
  const bool replaced = m.header.incarnation != newest_.header.incarnation ||
                        m.header.publish_time_ns < newest_.header.publish_time_ns - 1'000'000'000;
  if (replaced)
    for (auto& [id, known] : memory_) known.decided = false;  // a log that is played again contains the same ids
  for (const contact_event_t& e : m.events) memory_.try_emplace(e.event_id, {arrival, false});
  if (replaced || m.header.publish_time_ns >= newest_.header.publish_time_ns) {
    newest_.header = m.header;
    newest_arrival_ = arrival;
    newest_.clock = m.clock;
    newest_.pages = 1;
  }
  if (stack.empty()) {
    for (const contact_event_t& e : m.events) decides(e.event_id);
    return waiting_.push(arrival, m, arrival);
  }
  if (stack.lost_on_wire(wire_key(m), sim_time(m.header.sim_time_ns))) return;
  waiting_.push(arrival, newest_, arrival);
  for (const contact_event_t& heard : m.events) {
    if (!decides(heard.event_id)) continue;
    const Decision v = stack.decide(item_of(heard, m.header.incarnation, arrival));
    const bool later = stack.presentation_delay(sim_time(heard.time_ns)) > Nanoseconds(0);
    if (decisions && (v.touched || later))
      decisions->push_back(
          {static_cast<std::uint64_t>(heard.event_id), true, sim_time(heard.time_ns), v, arrival});
    if (v.dropped()) {
      if (dropped_.size() < kMaxDropped) dropped_.push_back(heard);
      continue;
    }
    contact_events_t late = newest_;
    late.events.push_back(heard);
    late.count = 1;
    contact_event_t& e = late.events.front();
    if (stack.changes_values()) change_values(e, stack);
    e.time_ns += v.shift.count();
    if (v.twice) waiting_.push(v.release, late, arrival);
    waiting_.push(v.release, std::move(late), arrival);
  }
}

std::optional<std::pair<contact_events_t, HostTime>> DegradedEvents::pop(HostTime now) {
  auto next = waiting_.pop(now);
  if (next && next->first.header.incarnation == newest_.header.incarnation) {
    next->first.header.publish_time_ns = newest_.header.publish_time_ns;
    next->second = newest_arrival_;
    next->first.clock = newest_.clock;
  }
  return next;
}

}  // namespace tactus::sync
