#include "sync/resampling/contact_stream.h"

#include <algorithm>
#include <iterator>
#include <tactus/contact_frame_t.hpp>
#include <tactus/contact_t.hpp>

namespace tactus::sync {
namespace {

// Minimum number of snapshots, of any age.
constexpr std::size_t kSnapshots = 128;
// Incomplete snapshots: 50 of the tool group while a network delays some of its pages by kStaleAfter. The limit on all their
// pages together allows fewer large ones.
constexpr PageLimits kPartial{
    .groups = 64, .pages = ContactStream::kMaxPages, .total = 8 * static_cast<std::size_t>(ContactStream::kMaxPages)};

float mix(float a, float b, double s) { return static_cast<float>((1 - s) * a + s * b); }

// Interpolates the scalars of one contact between two snapshots; points and normal stay those of the older.
contact_t between(contact_t a, const contact_t& b, double s) {
  a.depth_m = mix(a.depth_m, b.depth_m, s);
  a.area_m2 = mix(a.area_m2, b.area_m2, s);
  a.normal_force_N = mix(a.normal_force_N, b.normal_force_N, s);
  a.impulse_N_s = mix(a.impulse_N_s, b.impulse_N_s, s);
  return a;
}

Contacts::const_iterator find(const Contacts& list, std::int64_t id) {
  return std::find_if(list.begin(), list.end(), [id](const contact_t& c) { return c.contact_id == id; });
}

}  // namespace

ContactStream::ContactStream(EventInbox& events)
    : events_(events), partial_{Pages(kPartial, PageOrder::kKey), Pages(kPartial, PageOrder::kKey), Pages(kPartial, PageOrder::kKey)} {}

ContactStream::ContactStream(OwnClock own)
    : own_events_(std::make_unique<EventInbox>(own)),
      events_(*own_events_),
      partial_{Pages(kPartial, PageOrder::kKey), Pages(kPartial, PageOrder::kKey), Pages(kPartial, PageOrder::kKey)} {}

void ContactStream::follow_events() {
  if (epoch_ != events_.epoch()) {
    epoch_ = events_.epoch();
    for (auto& group : partial_) group.clear();
    for (auto& group : snapshots_) group.clear();
    for (auto& kept : contact_counts_) kept = 0;
  }
  const SimTime latest = events_.latest_plausible();
  for (std::size_t group = 0; group < kGroups; ++group) {
    partial_[group].drop_if([&](SimTime t) { return t > latest; });
    auto& snapshots = snapshots_[group];
    while (!snapshots.empty() && snapshots.back().time > latest) {
      contact_counts_[group] -= snapshots.back().contacts.size();
      snapshots.pop_back();
    }
  }
}

void ContactStream::push(const contact_frame_t& m, HostTime arrival) {
  if (!events_.follow(m.header, m.clock, arrival)) return;
  follow_events();
  const auto group = static_cast<std::size_t>(m.group);
  const SimTime time = sim_time(m.header.sim_time_ns);
  if (time > events_.latest_plausible() || m.pages > kMaxPages || group >= kGroups) {
    ++refused_;
    return;
  }
  const auto& snapshots = snapshots_[group];
  // Repeated, or older than all stored snapshots.
  if (!snapshots.empty() && snapshots.size() >= kSnapshots && time < snapshots.front().time) return;
  const auto at = std::lower_bound(snapshots.begin(), snapshots.end(), time, [](const Snapshot& s, SimTime t) { return s.time < t; });
  if (at != snapshots.end() && at->time == time) return;
  const Pages::Group* whole = partial_[group].add(time, m.page, m.pages, {m.contacts, m.header.seq});
  if (!whole) return;
  Snapshot snapshot{time, {}, {}};
  for (const auto& [number, page] : whole->pages) {
    snapshot.contacts.insert(snapshot.contacts.end(), page.contacts.begin(), page.contacts.end());
    snapshot.seqs.resize(snapshot.contacts.size(), page.seq);
  }
  // An overtaken snapshot may still be completed, unless it is too old to matter.
  partial_[group].drop_if([&](SimTime t) { return t < time - kStaleAfter; });
  insert(group, std::move(snapshot));
}

// Inserts a snapshot in order of time. An overtaken snapshot is inserted, too: later snapshots do not make it useless.
void ContactStream::insert(std::size_t group, Snapshot snapshot) {
  auto& snapshots = snapshots_[group];
  contact_counts_[group] += snapshot.contacts.size();
  const auto newer = [&](const Snapshot& s) { return s.time > snapshot.time; };
  snapshots.insert(std::find_if_not(snapshots.rbegin(), snapshots.rend(), newer).base(), std::move(snapshot));
  const auto too_old = [&] { return snapshots.size() > kSnapshots && snapshots.back().time - snapshots.front().time > span_; };
  while (too_old() || (contact_counts_[group] > kMaxContacts && snapshots.size() > 1)) {
    contact_counts_[group] -= snapshots.front().contacts.size();
    snapshots.pop_front();
  }
}

bool ContactStream::active(std::int64_t contact_id, SimTime t) const {
  const ContactSpan* span = events_.span_of(contact_id);
  if (!span) return true;  // joined late: its begin was not received
  return (!span->begin || sim_time(span->begin->time_ns) <= t) && (!span->end || *span->end > t);
}

SampleStatus ContactStream::status(const std::deque<Snapshot>& group, SimTime t) const {
  if (group.empty() || t < group.front().time) return SampleStatus::kNone;
  if (t > group.back().time) return t - group.back().time <= kStaleAfter ? SampleStatus::kHeld : SampleStatus::kStale;
  const auto it =
      std::lower_bound(group.begin(), group.end(), t, [](const Snapshot& s, SimTime x) { return s.time < x; });
  return it->time == t ? SampleStatus::kExact : SampleStatus::kInterpolated;
}

// True for a contact that is predicted only: neither the snapshot before nor a begin event contains it. It may never happen.
bool ContactStream::predicted_only(std::size_t group, std::deque<Snapshot>::const_iterator snapshot, std::int64_t id) const {
  if (group != contact_frame_t::AHEAD) return false;
  const ContactSpan* span = events_.span_of(id);
  if (span && span->begin) return false;
  return snapshot == snapshots_[group].begin() || find(std::prev(snapshot)->contacts, id) == std::prev(snapshot)->contacts.end();
}

void ContactStream::append_state(std::size_t number, SimTime t, std::vector<Candidate>& out) const {
  const auto& group = snapshots_[number];
  if (status(group, t) == SampleStatus::kNone) return;
  const auto after =
      std::upper_bound(group.begin(), group.end(), t, [](SimTime x, const Snapshot& s) { return x < s.time; });
  const auto before = std::prev(after);
  for (std::size_t i = 0; i < before->contacts.size(); ++i) {
    const contact_t& c = before->contacts[i];
    if (!active(c.contact_id, t) || predicted_only(number, before, c.contact_id)) continue;
    out.push_back({c, before->seqs[i], true});
    if (after == group.end()) continue;
    const auto next = find(after->contacts, c.contact_id);
    const double s = to_seconds(t - before->time) / to_seconds(after->time - before->time);
    if (next != after->contacts.end()) out.back().contact = between(c, *next, s);
  }
  if (after == group.end()) return;
  // Contacts that began since the older snapshot: the newer snapshot contains them, and their begin event shows that they
  // existed at t.
  for (std::size_t i = 0; i < after->contacts.size(); ++i) {
    const contact_t& c = after->contacts[i];
    const ContactSpan* span = events_.span_of(c.contact_id);
    const bool begun = span && span->begin && sim_time(span->begin->time_ns) <= t;
    if (begun && active(c.contact_id, t) && find(before->contacts, c.contact_id) == before->contacts.end())
      out.push_back({c, after->seqs[i], false});
  }
}

// Removes duplicates of a contact that moved between the groups of bodies: a snapshot at or before t takes precedence over a
// later one, then the page that was published last.
void ContactStream::keep_last_published(std::vector<Candidate>& list) {
  const auto better = [](const Candidate& a, const Candidate& b) { return std::pair(a.present, a.seq) > std::pair(b.present, b.seq); };
  std::map<std::int64_t, std::size_t> at;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto [it, first] = at.try_emplace(list[i].contact.contact_id, kept);
    if (!first && better(list[i], list[it->second])) std::swap(list[it->second], list[i]);
    if (!first) continue;
    if (kept != i) std::swap(list[kept], list[i]);
    ++kept;
  }
  list.resize(kept);
}

Sample<Contacts> ContactStream::state_at(SimTime t) {
  follow_events();
  Sample<Contacts> state;
  std::vector<Candidate> found;
  for (std::size_t group = 0; group < kGroups; ++group) {
    state.status = std::max(state.status, status(snapshots_[group], t));
    append_state(group, t, found);
  }
  keep_last_published(found);
  for (Candidate& c : found) state.value.push_back(std::move(c.contact));
  return state;
}

}  // namespace tactus::sync
