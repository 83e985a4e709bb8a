// Brute-force reference of the data that a receiver can have: the set of received packets, all else from the truth.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <tactus/body_state_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/contact_frame_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/resampling/contact_stream.h"
#include "tests/sync/support/hostile_world.h"

namespace tactus::hostile {

using sync::SampleStatus;

// State for one incarnation of the simulation; a new incarnation starts empty.
struct Known {
  std::map<std::int64_t, contact_event_t> events;  // all received events, by id
  std::set<std::int64_t> taken;
  std::map<std::int64_t, std::set<int>> pages[3];  // by group, times of contact snapshots
  std::set<std::int64_t> complete[3];
  std::map<int, std::set<std::int64_t>> bodies;  // times of the samples of each body
  std::optional<std::int64_t> newest_world_ns;
  std::int64_t least_latency_ns = INT64_MAX;
};

// Reference of the receiver of contacts or of that of poses: each tracks the simulation from its own messages.
class Reference {
 public:
  explicit Reference(const World& world) : world_(world) {}

  // Adds a received packet. A packet of an earlier incarnation is ignored; one of a later incarnation clears the state.
  void push(const Packet& p) {
    if (life_ && p.life < *life_) return;
    if (life_ != p.life) known_ = {};
    life_ = p.life;
    known_.least_latency_ns = std::min(known_.least_latency_ns, p.latency_ns);
    std::visit([&](const auto& m) { record(m); }, p.message);
  }

  const Life& life() const { return world_.lives[*life_]; }
  bool heard() const { return life_.has_value(); }

  // Ids of the events due before `until`, in order, each once.
  std::vector<std::int64_t> take_events(std::int64_t until_ns) {
    std::vector<std::pair<std::int64_t, std::int64_t>> due;
    for (const auto& [id, e] : known_.events)
      if (e.time_ns < until_ns && known_.taken.insert(id).second) due.push_back({e.time_ns, id});
    std::stable_sort(due.begin(), due.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::int64_t> ids;
    for (const auto& [time, id] : due) ids.push_back(id);
    return ids;
  }

  // Begin or end of a contact, as far as received events contain it.
  std::optional<std::int64_t> event_time(const TrueContact& c, std::int8_t kind) const {
    for (const auto& [id, e] : known_.events)
      if (e.contact_id == c.shown.contact_id && e.kind == kind) return e.time_ns;
    return std::nullopt;
  }
  bool may_live(const TrueContact& c, std::int64_t t) const {
    const auto begin = event_time(c, contact_event_t::BEGIN), end = event_time(c, contact_event_t::END);
    return (!begin || *begin <= t) && (!end || t < *end);
  }

  std::optional<std::int64_t> snapshot_before(int group, std::int64_t t) const {
    const auto after = known_.complete[group].upper_bound(t);
    return after == known_.complete[group].begin() ? std::nullopt : std::optional(*std::prev(after));
  }
  std::optional<std::int64_t> snapshot_after(int group, std::int64_t t) const {
    const auto after = known_.complete[group].upper_bound(t);
    return after == known_.complete[group].end() ? std::nullopt : std::optional(*after);
  }

  SampleStatus status(int group, std::int64_t t) const {
    const auto before = snapshot_before(group, t);
    if (!before) return SampleStatus::kNone;
    if (*before == t) return SampleStatus::kExact;
    if (snapshot_after(group, t)) return SampleStatus::kInterpolated;
    return t - *before <= to_ns(sync::SimTime(sync::ContactStream::kStaleAfter)) ? SampleStatus::kHeld : SampleStatus::kStale;
  }

  // A contact that is published ahead may not happen: it counts once its begin event or an earlier snapshot also contains it.
  bool predicted_only(const TrueContact& c, std::int64_t snapshot_ns) const {
    if (c.group != contact_frame_t::AHEAD || event_time(c, contact_event_t::BEGIN)) return false;
    const auto earlier = snapshot_before(c.group, snapshot_ns - 1);
    return !earlier || !c.alive(*earlier);
  }

  // Normal force of each live contact at t, N.
  std::map<std::int64_t, float> state(std::int64_t t) const {
    std::map<std::int64_t, float> out;
    for (const TrueContact& c : life().contacts) {
      const auto before = snapshot_before(c.group, t), after = snapshot_after(c.group, t);
      if (!before || !may_live(c, t)) continue;
      const bool in_before = c.alive(*before) && !predicted_only(c, *before), in_after = after && c.alive(*after);
      if (in_before && in_after)
        out[c.shown.contact_id] = c.force(t);
      else if (in_before)
        out[c.shown.contact_id] = c.force(*before);
      else if (in_after && event_time(c, contact_event_t::BEGIN))
        out[c.shown.contact_id] = c.force(*after);
    }
    return out;
  }

  // Contacts over [t0, t1) of simulated time, integrated piecewise: between two instants of change all values are constant.
  sync::ContactIntegral integral(std::int64_t t0, std::int64_t t1, int tool) const;
  // True when every begin and end of the tool's contacts in [t0, t1) or before have arrived, and snapshots reach over the span. The
  // received data then equal the truth.
  bool knows_all(std::int64_t t0, std::int64_t t1, int tool) const;
  std::int64_t true_contact_time_ns(std::int64_t t0, std::int64_t t1, int tool) const;

  const Known& known() const { return known_; }

 private:
  void record(const contact_events_t& m) {
    for (const contact_event_t& e : m.events) known_.events.try_emplace(e.event_id, e);
  }
  void record(const contact_frame_t& m) {
    auto& arrived = known_.pages[m.group][m.header.sim_time_ns];
    arrived.insert(m.page);
    if (static_cast<int>(arrived.size()) == m.pages) known_.complete[m.group].insert(m.header.sim_time_ns);
  }
  void record(const world_state_t& m) {
    for (const body_state_t& b : m.bodies) known_.bodies[b.body].insert(m.header.sim_time_ns);
    known_.newest_world_ns = std::max(known_.newest_world_ns.value_or(0), m.header.sim_time_ns);
  }

  const World& world_;
  std::optional<std::size_t> life_;
  Known known_;
};

namespace reference_detail {

struct Touch {
  const TrueContact* contact;
  std::optional<std::int64_t> begin, end;  // as received
  std::int64_t shown_ns = 0;               // how long snapshots contain it
};

}  // namespace reference_detail

inline sync::ContactIntegral Reference::integral(std::int64_t t0, std::int64_t t1, int tool) const {
  constexpr std::int64_t kStale = 50 * kMs;
  const auto& complete = known_.complete[0];
  std::vector<reference_detail::Touch> touches;
  std::set<std::int64_t> cuts{t0, t1};
  const auto cut = [&](std::int64_t t) {
    if (t > t0 && t < t1) cuts.insert(t);
  };
  for (const TrueContact& c : life().contacts) {
    if (c.group != 0 || c.shown.tool != tool) continue;
    touches.push_back({&c, event_time(c, contact_event_t::BEGIN), event_time(c, contact_event_t::END)});
    if (touches.back().begin) cut(*touches.back().begin);
    if (touches.back().end) cut(*touches.back().end);
  }
  for (auto s = complete.lower_bound(t0); s != complete.end() && *s < t1; ++s) cut(*s);
  if (!complete.empty()) cut(*complete.rbegin() + kStale);

  sync::ContactIntegral sum;
  sum.status = status(0, t1 - 1);
  const auto length = static_cast<double>(t1 - t0);
  std::set<std::int64_t> touched_from;  // start times of the pieces with a contact
  for (auto a = cuts.begin(); std::next(a) != cuts.end(); ++a) {
    const std::int64_t from = *a, until = *std::next(a);
    const auto before = snapshot_before(0, from), after = snapshot_after(0, from);
    for (auto& t : touches) {
      if (!before || (t.begin && from < *t.begin) || (t.end && from >= *t.end)) continue;
      const bool shown = t.contact->alive(*before) && (after || from < *before + kStale);
      const bool shown_later = after && t.contact->alive(*after) && t.begin;
      if (!shown && !shown_later) continue;
      const double share = static_cast<double>(until - from) / length;
      const float force = t.contact->force(shown ? *before : *after);
      sum.force_N += force * share;
      sum.area_m2 += 1e-5f * force * share;
      t.shown_ns += until - from;
      touched_from.insert(from);
    }
  }
  // Contacts that no snapshot shows in this tick: from their events, with the momentum of their begin.
  for (auto& t : touches) {
    if (t.shown_ns > 0 || !t.begin || !t.end || *t.begin >= t1 || *t.end <= t0) continue;
    for (auto a = cuts.begin(); std::next(a) != cuts.end(); ++a)
      if (*a >= *t.begin && *a < *t.end) touched_from.insert(*a);
    if (*t.begin < t0) continue;
    for (const auto& [id, e] : known_.events)
      if (e.contact_id == t.contact->shown.contact_id && e.kind == contact_event_t::BEGIN)
        sum.force_N += e.effective_mass_kg * e.approach_speed_m_s / (length * 1e-9);
  }
  std::int64_t touched_ns = 0;
  for (const std::int64_t from : touched_from) touched_ns += *std::next(cuts.find(from)) - from;
  sum.contact_time = sync::Nanoseconds(touched_ns);
  return sum;
}

inline bool Reference::knows_all(std::int64_t t0, std::int64_t t1, int tool) const {
  if (!snapshot_before(0, t0) || *known_.complete[0].rbegin() + 50 * kMs < t1) return false;
  for (const TrueContact& c : life().contacts) {
    if (c.group != 0 || c.shown.tool != tool) continue;
    if (c.begin_ns < t1 && !event_time(c, contact_event_t::BEGIN)) return false;
    if (c.begin_ns < t1 && c.end_ns < t1 && !event_time(c, contact_event_t::END)) return false;
    // Only its announced end may have arrived.
    if (c.begin_ns < t1 && c.end_ns >= t1 && !snapshot_after(0, c.begin_ns - 1)) return false;
    if (c.begin_ns < t1 && c.end_ns >= t1 && *snapshot_after(0, c.begin_ns - 1) >= c.end_ns &&
        !event_time(c, contact_event_t::END))
      return false;
  }
  return true;
}

inline std::int64_t Reference::true_contact_time_ns(std::int64_t t0, std::int64_t t1, int tool) const {
  std::vector<std::pair<std::int64_t, int>> changes;  // changes of the number of contacts
  for (const TrueContact& c : life().contacts) {
    const std::int64_t begin = std::max(t0, c.begin_ns), end = std::min(t1, c.end_ns);
    if (c.group != 0 || c.shown.tool != tool || begin >= end) continue;
    changes.push_back({begin, 1});
    changes.push_back({end, -1});
  }
  std::sort(changes.begin(), changes.end());
  std::int64_t sum = 0, since = 0;
  int contacts = 0;
  for (const auto& [t, change] : changes) {
    if (contacts > 0) sum += t - since;
    contacts += change;
    since = t;
  }
  return sum;
}

}  // namespace tactus::hostile
