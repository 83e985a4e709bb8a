#include "sim_node/dual/visual_step.h"

#include <algorithm>

#include "sim_node/dual/state_limits.h"
#include "sim_node/model/archive_motion.h"

namespace tactus::sim {
namespace {

constexpr std::size_t kMaxCoordinates = 1 << 16, kMaxSubSteps = 64;

void archive_unit(StateArchive& a, impulse::UnitState& s) {
  a(s.body.centre_m), a(s.body.orientation), a(s.body.velocity_m_s), a(s.body.spin_rad_s);
  a.list(s.joints.positions, kMaxCoordinates, [&](double& x) { a(x); });
  a.list(s.joints.rates, kMaxCoordinates, [&](double& x) { a(x); });
  a(s.joints.reach_s);
}

void archive_time(StateArchive& a, sync::Nanoseconds& t) {
  std::int64_t ns = t.count();
  a(ns);
  a.require(ns >= 0 && ns <= 1'000'000'000, "the state holds a time out of range");
  t = sync::Nanoseconds(ns);
}

// Indices of units or bodies, ascending.
void archive_numbers(StateArchive& a, std::vector<int>& numbers, std::size_t count) {
  a.list(numbers, count, [&](int& n) {
    a.index(n, count);
    a.require(n >= 0, "the state names a body that does not exist");
  });
  a.require(std::is_sorted(numbers.begin(), numbers.end()), "the state holds an unsorted list");
}

}  // namespace

void shift(LiveContact& c, sync::Nanoseconds by) {
  for (sync::SimTime* t : {&c.last_hit, &c.last_event, &c.separated_since}) *t += by;
}

int UnitTransfer::find(int unit) const {
  const auto at = std::lower_bound(units.begin(), units.end(), unit);
  return at != units.end() && *at == unit ? static_cast<int>(at - units.begin()) : -1;
}

void UnitTransfer::archive(StateArchive& a, int max_units, std::size_t bodies, ContactTracker& tracker) {
  const auto count = static_cast<std::size_t>(max_units);
  a.list(units, count, [&](int& unit) {
    a.index(unit, count);
    a.require(unit >= 0, "the state names a body that does not exist");
  });
  a.require(std::is_sorted(units.begin(), units.end()), "the state holds an unsorted list");
  a.list(states, count, [&](impulse::UnitState& s) { archive_unit(a, s); });
  a.require(states.size() == units.size(), "the state holds a list that is too long");
  a.list(contacts, kMaxStoredContacts, [&](LiveContact& c) { tracker.archive(a, c, bodies); });
}

void VisualTask::archive(StateArchive& a, int units, std::size_t bodies, ContactTracker& tracker) {
  a(number);
  archive_time(a, length), archive_time(a, catch_up_time);
  entering.archive(a, units, bodies, tracker);
  archive_numbers(a, leaving, static_cast<std::size_t>(units));
  a.list(changes, kMaxStoredChanges, [&](impulse::SceneChange& c) { c.archive(a, bodies); });
}

void VisualStep::archive(StateArchive& a, int max_units, std::size_t count, ContactTracker& tracker) {
  task.archive(a, max_units, count, tracker);
  a(begins);
  archive_numbers(a, units, static_cast<std::size_t>(max_units)), archive_numbers(a, bodies, count);
  a.list(times, kMaxSubSteps, [&](sync::Nanoseconds& t) { archive_time(a, t); });
  a.list(states, kMaxSubSteps, [&](auto& list) {
    a.list(list, static_cast<std::size_t>(max_units), [&](impulse::UnitState& s) { archive_unit(a, s); });
    a.require(list.size() == units.size(), "the state holds a list that is too long");
  });
  a.list(live, kMaxSubSteps,
         [&](auto& list) { a.list(list, kMaxStoredContacts, [&](LiveContact& c) { tracker.archive(a, c, count); }); });
  a.require(!times.empty() && states.size() == times.size() && live.size() == times.size(),
            "the state holds a list that is too long");
  for (auto* list : {&begin, &end}) {
    a.list(*list, count, [&](BodyMotion& m) { sim::archive(a, m); });
    a.require(list->size() == count, "the state belongs to another scene");
  }
  trajectories.archive(a, count);
  a.list(events, kMaxStoredContacts, [&](contact_event_t& e) { a.message(e); });
  a(asleep);
}

void VisualStep::rename(const Ids& ids) {
  for (auto& list : live)
    for (LiveContact& c : list) c.id = ids.renamed(c.id);
  for (LiveContact& c : task.entering.contacts) c.id = ids.renamed(c.id);
  for (contact_event_t& e : events) {
    e.event_id = ids.renamed(e.event_id);
    e.contact_id = ids.renamed(e.contact_id);
  }
}

std::size_t VisualStep::time_before(sync::Nanoseconds passed) const {
  const auto after = std::upper_bound(times.begin(), times.end(), passed);
  return after == times.begin() ? 0 : static_cast<std::size_t>(after - times.begin()) - 1;
}

}  // namespace tactus::sim
