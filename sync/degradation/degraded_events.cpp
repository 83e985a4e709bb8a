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
bool DegradedEvents::decide_once(std::int64_t id) {
  return !std::exchange(memory_.try_emplace(id).first.decided, true);
}

void DegradedEvents::push(const contact_events_t& m, HostTime arrival, OperatorChain& operators, Decisions* decisions) {
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
  if (operators.empty()) {
    for (const contact_event_t& e : m.events) decide_once(e.event_id);
    return waiting_.push(arrival, m, arrival);
  }
  if (operators.lost_on_wire(wire_key(m), sim_time(m.header.sim_time_ns))) return;
  waiting_.push(arrival, newest_, arrival);
  for (const contact_event_t& received : m.events) {
    if (!decide_once(received.event_id)) continue;
    const Decision decision = operators.decide(item_of(received, m.header.incarnation, arrival));
    const bool is_delayed = operators.presentation_delay(sim_time(received.time_ns)) > Nanoseconds(0);
    if (decisions && (decision.evaluated || is_delayed))
      decisions->push_back(
          {static_cast<std::uint64_t>(received.event_id), true, sim_time(received.time_ns), decision, arrival});
    if (decision.dropped()) {
      if (dropped_.size() < kMaxDropped) dropped_.push_back(received);
      continue;
    }
    contact_events_t delayed = newest_;
    delayed.events.push_back(received);
    delayed.count = 1;
    contact_event_t& e = delayed.events.front();
    if (operators.changes_values()) change_values(e, operators);
    e.time_ns += decision.shift.count();
    if (decision.duplicated) waiting_.push(decision.release, delayed, arrival);
    waiting_.push(decision.release, std::move(delayed), arrival);
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
