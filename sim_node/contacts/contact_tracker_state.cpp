#include <algorithm>

#include "sim_node/contacts/contact_tracker.h"
#include "sim_node/model/archive_motion.h"

namespace tactus::sim {
namespace {

// Larger than the number of points that a step can solve.
constexpr std::size_t kMaxContacts = 1 << 16;

}  // namespace

void ContactTracker::archive(StateArchive& a, LiveContact& c, std::size_t bodies) {
  a(c.id);
  sim::archive(a, c.manifold, bodies, surfaces_.size());
  a(c.a_body_m), a(c.b_body_m), a(c.touching), a(c.gap_m), a(c.normal_force_N), a(c.impulse_N_s);
  a(c.armed), a(c.last_hit), a(c.last_event), a(c.has_hit), a(c.separated_since), a(c.position_m),
      a(c.rolling_m_s);
}

void ContactTracker::archive(StateArchive& a, std::size_t bodies) {
  a(now_);
  a.list(live_, kMaxContacts, [&](LiveContact& c) { archive(a, c, bodies); });
}

void ContactTracker::extract(std::span<const char> marked, std::vector<LiveContact>& out) {
  const auto is_marked = [&](const LiveContact& c) {
    return marked[static_cast<std::size_t>(c.manifold.body_a)] || marked[static_cast<std::size_t>(c.manifold.body_b)];
  };
  std::copy_if(live_.begin(), live_.end(), std::back_inserter(out), is_marked);
  std::erase_if(live_, is_marked);
}

void ContactTracker::insert(std::span<const LiveContact> contacts) {
  live_.insert(live_.end(), contacts.begin(), contacts.end());
  std::sort(live_.begin(), live_.end(),
            [](const LiveContact& x, const LiveContact& y) { return x.manifold.before(y.manifold); });
}

void ContactTracker::rename() {
  for (LiveContact& c : live_) c.id = ids_.renamed(c.id);
}

}  // namespace tactus::sim
