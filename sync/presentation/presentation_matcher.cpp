#include "sync/presentation/presentation_matcher.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <tactus/contact_event_t.hpp>
#include <tactus/decision_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/playout_entry_t.hpp>
#include <tactus/presentation_t.hpp>

#include "sync/degradation/known_modalities.h"

namespace tactus::sync {
namespace {

// A modality has at most three parts; with a realistic number of nodes, an event has fewer reports than this.
constexpr std::size_t kMaxReportsPerEvent = 64;

// Sorts the push of a modality before its other parts, and unknown modalities last, by name.
constexpr std::string_view kPush = "_push";
std::size_t naming_order(const std::string& name) {
  const bool push = name.ends_with(kPush);
  const std::size_t known = modality_index(push ? name.substr(0, name.size() - kPush.size()) : name);
  return known < known_modalities().size() ? 2 * known + (push ? 0 : 1) : 2 * known;
}

bool was_presented(std::int8_t outcome) {
  return outcome == presentation_t::PRESENTED || outcome == presentation_t::LATE ||
         outcome == presentation_t::INAUDIBLE;
}

// Bounds on reported durations, so that sums do not overflow.
constexpr Nanoseconds kMaxDelay{
    61'000'000'000};  // the delays of a profile are at most 60 s each; a longer one counts as dropped
constexpr Nanoseconds kMaxUncertainty{60'000'000'000};

// Touch presents a hit as the transient and a begin as the constraint force, whose onset may precede the event.
bool is_onset(std::int8_t part, std::int8_t kind) {
  return part == presentation_t::WHOLE ||
         part == (kind == contact_event_t::HIT ? presentation_t::TRANSIENT : presentation_t::CONSTRAINT);
}

template <class Map>
bool has_room(const Map& map, const typename Map::key_type& key, std::size_t max_size) {
  return map.size() < max_size || map.contains(key);
}

}  // namespace

bool named_before(const std::string& a, const std::string& b) {
  return std::pair(naming_order(a), a) < std::pair(naming_order(b), b);
}

PresentationMatcher::Event* PresentationMatcher::find_or_add(std::int64_t id, HostTime arrival) {
  const auto it = events_.find(id);
  if (it != events_.end()) return &it->second;
  if (events_.size() >= kMaxEvents) return ++overflow_, nullptr;
  forget_.emplace(arrival + kSettleAfter + kRemember, id);
  return &events_[id];
}

SenderClock& PresentationMatcher::clock_of(const header_t& h, HostTime arrival) {
  // A removed clock is learnt again when its sender publishes again.
  if (!has_room(clocks_, h.source, kMaxModalities)) clocks_.erase(clocks_.begin());
  SenderClock& clock = clocks_.try_emplace(h.source, own_).first->second;
  clock.observe(h, arrival);
  return clock;
}

void PresentationMatcher::observe(const contact_events_t& m, HostTime arrival) {
  const bool any_run = own_.run_id == 0;
  const bool ours = any_run || m.header.run_id == own_.run_id;
  if (ours && has_room(simulations_, m.header.source, kMaxModalities)) simulations_.insert(m.header.source);
  if (!ours && simulation_last_seen_ && arrival - *simulation_last_seen_ < kSettleAfter) return;
  TimeMap map{sim_time(m.clock.sim_ns), host_time(m.clock.host_ns), m.clock.rate};
  if (!any_run) map.host = clock_of(m.header, arrival).to_host(m.clock.host_ns, arrival);
  for (const contact_event_t& e : m.events) {
    Event* event = find_or_add(e.event_id, arrival);
    if (event == nullptr || event->known) continue;
    event->known = true;
    event->kind = e.kind;
    event->tool = e.tool;
    event->source = ours ? m.header.source : 0;  // the health of a simulation of another run is ignored
    event->incarnation = m.header.incarnation;
    // An event cannot be published before it happened.
    event->time = std::min(map.to_host(sim_time(e.time_ns)), arrival);
    due_.emplace(std::max(event->time + kSettleAfter, arrival + kSettleAfter / 2), e.event_id);
    ++(e.kind == contact_event_t::BEGIN ? begins_ : e.kind == contact_event_t::HIT ? hits_ : ends_);
  }
}

void PresentationMatcher::observe(const node_health_t& m, HostTime arrival) {
  if (own_.run_id == 0) own_ = OwnClock(m.header.run_id, m.header.clock, own_.maps);
  if (m.header.run_id != own_.run_id) return;
  if (!has_room(renderers_, m.header.source, kMaxModalities) ||
      (!m.modality.empty() && !has_room(tallies_, m.modality, kMaxModalities))) {
    ++overflow_;
    return;
  }
  Renderer& r = renderers_[m.header.source];
  r.modality = m.modality;
  r.expected_events = m.expected_events;
  r.tool = m.tool;
  const HostTime sent = clock_of(m.header, arrival).to_host(m.header.publish_time_ns, arrival);
  if (simulations_.contains(m.header.source)) simulation_last_seen_ = arrival;
  const bool returned = r.activity.observe(m.header.incarnation, m.state, sent);
  std::erase_if(final_expectations_,
                [&](const FinalExpectation& d) { return d.source == m.header.source || d.simulation == m.header.source; });
  if (r.modality.empty()) return;
  OutcomeCounts& tally = tallies_[r.modality];
  if (returned) {
    tally.dead -= r.provisionally_dead;
    tally.stalled += r.provisionally_dead;
  }
  r.provisionally_dead = 0;
}

void PresentationMatcher::observe(const presented_t& m, HostTime arrival) {
  if (m.header.run_id != own_.run_id) return;
  const SenderClock& clock = clock_of(m.header, arrival);
  for (const presentation_t& p : m.reports) {
    Event* event = find_or_add(p.event_id, arrival);
    if (event == nullptr || event->reports.size() >= kMaxReportsPerEvent) continue;
    const auto same = [&](const Report& r) { return r.source == m.header.source && r.part == p.part; };
    if (std::any_of(event->reports.begin(), event->reports.end(), same)) continue;
    if (p.scheduled_ns >= 0 && event->known && has_room(reported_delay_, m.modality, kMaxModalities)) {
      const SenderClock::Reading at = clock.read(p.scheduled_ns, arrival);
      const auto held = event->held.find(m.modality);
      if (at.uncertainty >= Nanoseconds(0))
        reported_delay_[m.modality] =
            std::clamp(at.time - event->time - (held == event->held.end() ? Nanoseconds(0) : held->second), Nanoseconds(0), kMaxDelay);
    }
    Report report{m.header.source, m.modality, p.part, p.outcome, -1, Nanoseconds(0)};
    if (p.presented_ns >= 0) {
      const SenderClock::Reading at = clock.read(p.presented_ns, arrival);
      if (at.uncertainty >= Nanoseconds(0)) {
        report.presented_ns = to_ns(at.time);
        report.uncertainty = Nanoseconds(std::min(p.uncertainty_ns, kMaxUncertainty.count())) + at.uncertainty;
      }  // else its clock has no map: it counts as presented, but its uncertainty is unknown, so it has no asynchrony
    }
    if (p.ready_ns >= 0 && event->known && needs_.size() < kMaxNeeds) {
      const SenderClock::Reading ready = clock.read(p.ready_ns, arrival);
      if (ready.uncertainty >= Nanoseconds(0))
        needs_.push_back({p.event_id, m.modality, ready.time - event->time});
    }
    event->reports.push_back(std::move(report));
  }
}

std::map<std::string, bool> PresentationMatcher::running_modalities() const {
  std::map<std::string, bool> waited_for;
  for (const auto& [source, r] : renderers_)
    if (!r.modality.empty()) waited_for[r.modality] = (r.expected_events & node_health_t::OTHERS_DO_NOT_WAIT) == 0;
  return waited_for;
}

void PresentationMatcher::observe(const playout_t& m, HostTime arrival) {
  if (m.header.run_id != own_.run_id) return;
  lockstep_period_ = m.lockstep_Hz > 0 ? from_seconds(1 / m.lockstep_Hz) : Nanoseconds(0);
  for (const playout_entry_t& e : m.entries)
    if (has_room(playout_, e.modality, kMaxModalities))
      playout_.try_emplace(e.modality, e.modality).first->second.push(m, arrival);
}

void PresentationMatcher::observe(const degraded_t& m, HostTime) {
  if (m.header.run_id != own_.run_id) return;
  for (const decision_t& d : m.decisions) {
    const auto it = d.is_event ? events_.find(d.key) : events_.end();
    if (it == events_.end() || !has_room(it->second.held, m.modality, kMaxModalities)) continue;
    it->second.held[m.modality] = std::clamp(Nanoseconds(d.held_ns), Nanoseconds(0), kMaxDelay);
  }
}

Nanoseconds PresentationMatcher::intended_delay(const Event& e, const std::string& modality) const {
  const auto playout = playout_.find(modality);
  const auto held = e.held.find(modality);
  const auto reported = reported_delay_.find(modality);
  return lockstep_period_ +
         std::max(playout == playout_.end() ? Nanoseconds(0) : playout->second.delay(),
                  reported == reported_delay_.end() ? Nanoseconds(0) : reported->second) +
         (held == e.held.end() ? Nanoseconds(0) : held->second);
}

Nanoseconds PresentationMatcher::max_intended_delay(const Event& e) const {
  Nanoseconds max_delay{0};
  for (const auto& [modality, tally] : tallies_) max_delay = std::max(max_delay, intended_delay(e, modality));
  return max_delay;
}

void PresentationMatcher::advance(HostTime now) {
  for (auto& [modality, follower] : playout_) follower.step(now);
  while (!due_.empty() && due_.begin()->first <= now) {
    const std::int64_t id = due_.begin()->second;
    Event& event = events_.at(id);
    due_.erase(due_.begin());
    const Nanoseconds later = max_intended_delay(event);
    const HostTime until = event.time + later + kSettleAfter;
    if (later > Nanoseconds(0) && until > now)
      due_.emplace(until, id);
    else
      settle(event, now, false);
  }
  while (!forget_.empty() && forget_.begin()->first <= now) {
    const auto it = events_.find(forget_.begin()->second);
    forget_.erase(forget_.begin());
    if (it->second.known && !it->second.settled) {  // a modality has an intended delay
      forget_.emplace(now + kRemember, it->first);
      continue;
    }
    events_.erase(it);
  }
}

void PresentationMatcher::finish(HostTime now) {
  advance(now);
  for (const auto& [due, id] : due_) settle(events_.at(id), now, true);
  due_.clear();
  // At the end of a run all processes end before the log does; that is not a failure.
  for (const FinalExpectation& d : final_expectations_) {
    --tallies_[d.modality].expected;
    --tallies_[d.modality].dead;
  }
  final_expectations_.clear();
}

bool PresentationMatcher::expects(const Renderer& r, const Event& e) const {
  const int kind = e.kind == contact_event_t::BEGIN ? node_health_t::EXPECTS_BEGIN
                   : e.kind == contact_event_t::HIT ? node_health_t::EXPECTS_HIT
                                                    : 0;
  if (r.modality.empty() || (r.expected_events & kind) == 0) return false;
  return (r.expected_events & node_health_t::EXPECTS_OWN_TOOL_ONLY) == 0 || (e.tool >= 0 && e.tool == r.tool);
}

void PresentationMatcher::settle(Event& e, HostTime now, bool last) {
  e.settled = true;
  for (auto& [source, renderer] : renderers_)
    if (expects(renderer, e)) settle_expected(renderer, source, e, now, last);
  count_asynchrony(e);
}

void PresentationMatcher::settle_expected(Renderer& r, std::int32_t source, const Event& e, HostTime now, bool last) {
  const Nanoseconds later = intended_delay(e, r.modality);
  const NodeActivity::Result activity = r.activity.during(e.time, e.time + later + kReportsWithin, now);
  if (activity.state == NodeActivity::State::kAbsent) return;
  OutcomeCounts& tally = tallies_[r.modality];
  std::int64_t* outcome = nullptr;
  bool late = false;  // true when every presented part of it was late
  for (const Report& report : e.reports) {
    if (report.source != source) continue;
    if (was_presented(report.outcome)) {
      late = report.outcome == presentation_t::LATE;
      outcome = &tally.presented;
      if (!late) break;
    }
    if (outcome == &tally.presented) continue;
    const bool by_profile = report.outcome == presentation_t::DROPPED_BY_PROFILE;
    if (by_profile || outcome == nullptr) outcome = by_profile ? &tally.dropped_by_profile : &tally.dropped_late;
  }
  if (outcome == nullptr) {
    // The log ends before the event was due.
    if (last && later > Nanoseconds(0) && now < e.time + later + kReportsWithin) return;
    const auto simulation = renderers_.find(e.source);
    const bool source_died = simulation != renderers_.end() &&
                             (simulation->second.activity.died_before(e.incarnation, e.time + kRepeated, now) ||
                              simulation->second.activity.replaced_before(e.incarnation, e.time + later + kReportsWithin));
    if (last && (activity.may_return || activity.state == NodeActivity::State::kUndecided || source_died)) return;
    if (activity.state == NodeActivity::State::kStalled) {
      outcome = &tally.stalled;
    } else if (activity.state == NodeActivity::State::kDead || source_died) {
      outcome = &tally.dead;
      if (activity.may_return) ++r.provisionally_dead;
      if (simulation != renderers_.end() && simulation->second.activity.silent_since(e.time + kEndsWithin, now))
        final_expectations_.push_back({source, e.source, r.modality});
    } else {
      outcome = &tally.lost;
    }
  }
  ++tally.expected;
  ++*outcome;
  if (late) ++tally.late;
}

void PresentationMatcher::count_asynchrony(const Event& e) {
  // When one modality has several nodes (the walls of a room), uses the earliest presentation.
  std::map<std::string, const Report*> onset;
  for (const Report& r : e.reports) {
    if (!was_presented(r.outcome) || r.presented_ns < 0 || !is_onset(r.part, e.kind)) continue;
    const Report*& first = onset[r.part == presentation_t::CONSTRAINT ? r.modality + std::string(kPush) : r.modality];
    if (first == nullptr || r.presented_ns < first->presented_ns) first = &r;
  }
  for (const auto& [a, report_a] : onset)
    for (const auto& [b, report_b] : onset) {
      if (!named_before(a, b)) continue;
      if (has_room(pairs_, {a, b}, kMaxPairs))
        pairs_[{a, b}].add(Nanoseconds(report_b->presented_ns - report_a->presented_ns),
                           report_a->uncertainty + report_b->uncertainty);
      else
        ++overflow_;
    }
}

}  // namespace tactus::sync
