#include "sim_node/dual/visual_step.h"

#include <algorithm>

namespace tactus::sim {
namespace {

constexpr std::size_t kMostContacts = 1 << 16;  // as of a tracker
constexpr std::size_t kMostCoordinates = 1 << 16;

void archive(StateArchive& a, impulse::UnitState& s) {
  a(s.body.centre_m), a(s.body.orientation), a(s.body.velocity_m_s), a(s.body.spin_rad_s);
  a.list(s.joints.positions, kMostCoordinates, [&](double& x) { a(x); });
  a.list(s.joints.rates, kMostCoordinates, [&](double& x) { a(x); });
  a(s.joints.reach_s);
}

}  // namespace

void shift(LiveContact& c, sync::Nanoseconds by) {
  for (sync::SimTime* t : {&c.last_hit, &c.last_event, &c.apart_since}) *t += by;
}

int Handover::find(int unit) const {
  const auto at = std::lower_bound(units.begin(), units.end(), unit);
  return at != units.end() && *at == unit ? static_cast<int>(at - units.begin()) : -1;
}

void Handover::archive(StateArchive& a, int most, std::size_t bodies, ContactTracker& tracker) {
  const auto count = static_cast<std::size_t>(most);
  a.list(units, count, [&](int& unit) {
    a.index(unit, count);
    a.require(unit >= 0, "the state names a body that is not there");
  });
  a.require(std::is_sorted(units.begin(), units.end()), "the state holds a list in disorder");
  a.list(states, count, [&](impulse::UnitState& s) { sim::archive(a, s); });
  a.require(states.size() == units.size(), "the state holds a list that is too long");
  a.list(contacts, kMostContacts, [&](LiveContact& c) { tracker.archive(a, c, bodies); });
}

std::size_t VisualStep::time_before(sync::Nanoseconds passed) const {
  const auto after = std::upper_bound(times.begin(), times.end(), passed);
  return after == times.begin() ? 0 : static_cast<std::size_t>(after - times.begin()) - 1;
}

}  // namespace tactus::sim
