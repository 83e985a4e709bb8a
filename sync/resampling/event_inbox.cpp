#include "sync/resampling/event_inbox.h"

#include <algorithm>
#include <iterator>

#include "sync/degradation/snapshot.h"

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

// True once for each event.
bool EventInbox::decide_now(std::int64_t id) { return !std::exchange(memory_.try_emplace(id).first.decided, true); }

void EventInbox::push(const contact_events_t& m, HostTime arrival, OperatorChain& chain, Decisions* decisions) {
  const bool lost = !chain.empty() && chain.lost_on_wire(wire_key(m), sim_time(m.header.sim_time_ns));
  if (!lost && !follow(m.header, m.clock, arrival)) return;
  for (const contact_event_t& e : m.events) memory_.try_emplace(e.event_id, {arrival, false});
  if (lost) return;
  for (const contact_event_t& received : m.events) {
    if (!decide_now(received.event_id)) {
      ++duplicates_;
      continue;
    }
    if (chain.empty()) {
      hold(received, m.header.incarnation, arrival);
      continue;
    }
    const Decision v = chain.decide(item_of(received, m.header.incarnation, arrival));
    const bool later = chain.presentation_delay(sim_time(received.time_ns)) > Nanoseconds(0);
    if (decisions && (v.evaluated || later))
      decisions->push_back({static_cast<std::uint64_t>(received.event_id), true, sim_time(received.time_ns), v, arrival});
    if (v.dropped()) {
      if (dropped_.size() < kMaxDropped) dropped_.push_back(received);
      continue;
    }
    contact_event_t event = received;
    if (chain.changes_values()) change_values(event, chain);
    event.time_ns = std::max<std::int64_t>(0, event.time_ns + v.shift.count());
    memory_.try_emplace(event.event_id).first.shift = v.shift;
    if (v.duplicated) ++duplicates_;
    hold(event, m.header.incarnation, v.release);
  }
}

void EventInbox::hold(const contact_event_t& event, std::int64_t incarnation, HostTime release) {
  held_.emplace(release, HeldEvent{event, incarnation});
  if (held_.size() <= kMaxHeld) return;
  held_.erase(std::prev(held_.end()));
  ++overflow_;
}

void EventInbox::release(HostTime now) {
  while (!held_.empty() && held_.begin()->first <= now) {
    release_one(held_.begin()->second);
    held_.erase(held_.begin());
  }
}

// Drops an event of a replaced simulation, or of an impossible future.
void EventInbox::release_one(const HeldEvent& held) {
  contact_event_t e = held.event;
  if (held.incarnation != clock_.incarnation()) return;
  if (sim_time(e.time_ns) > clock_.latest_plausible()) {
    ++refused_;
    memory_.try_emplace(e.event_id).first.decided = false;  // a repetition may be credible
    return;
  }
  ContactSpan& span = spans_.try_emplace(e.contact_id).first;
  if (e.kind == contact_event_t::BEGIN) span.begin = e;
  // A jitter of the presentation shifts both ends of a contact; a short contact does not end before it begins.
  if (e.kind == contact_event_t::END && span.begin) e.time_ns = std::max(e.time_ns, span.begin->time_ns);
  if (e.kind == contact_event_t::END) span.end = sim_time(e.time_ns);
  pending_.emplace(sim_time(e.time_ns), e);
  if (pending_.size() <= kMaxPending) return;
  pending_.erase(std::prev(pending_.end()));
  ++overflow_;
}

bool EventInbox::follow(const header_t& header, const sim_clock_t& clock, HostTime arrival) {
  const TrackResult result = clock_.track(header, clock, arrival);
  if (result == TrackResult::kIgnore) return false;
  if (result == TrackResult::kRestart) {
    ++epoch_;
    spans_.clear();
    pending_.clear();
    for (auto& [id, known] : memory_) known.decided = false;  // a log that is played again contains the same ids
  }
  // Removes events that were accepted only because their corrupt message was the first one.
  pending_.erase(pending_.upper_bound(clock_.latest_plausible()), pending_.end());
  return true;
}

std::vector<contact_event_t> EventInbox::take(SimTime until) {
  std::vector<contact_event_t> due;
  const auto end = pending_.lower_bound(until);
  for (auto at = pending_.begin(); at != end; ++at) due.push_back(at->second);
  pending_.erase(pending_.begin(), end);
  return due;
}

const contact_event_t* EventInbox::front(SimTime until) const {
  return pending_.empty() || pending_.begin()->first >= until ? nullptr : &pending_.begin()->second;
}

void EventInbox::pop_front() {
  if (!pending_.empty()) pending_.erase(pending_.begin());
}

Nanoseconds EventInbox::shift_of(std::int64_t event_id) const {
  const Known* known = memory_.find(event_id);
  return known ? known->shift : Nanoseconds(0);
}

std::optional<HostTime> EventInbox::arrival_of(std::int64_t event_id) const {
  const Known* known = memory_.find(event_id);
  return known ? std::optional(known->arrival) : std::nullopt;
}

}  // namespace tactus::sync
