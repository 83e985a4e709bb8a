#include "sim_node/publish/snapshots.h"

#include "lcmtypes/vectors.h"
#include "sim_node/publish/paging.h"

namespace tactus::sim {
namespace {

// Less than this is rest, below what is seen and felt: 20 um and 0.02 degrees since it was last told, or at these speeds
// within a snapshot.
constexpr double kMoved_m = 2e-5;
constexpr double kTurned_rad = 4e-4;
constexpr double kMoving_m_s = 1e-3;
constexpr double kTurning_rad_s = 1e-2;

bool moves(const BodyMotion& m, const BodyMotion& told) {
  return (m.position_m - told.position_m).norm() > kMoved_m || m.orientation.angularDistance(told.orientation) > kTurned_rad ||
         m.velocity_m_s.norm() > kMoving_m_s || m.spin_rad_s.norm() > kTurning_rad_s;
}

body_state_t state_of(std::size_t body, const BodyMotion& m, bool moving) {
  body_state_t b{};
  b.body = static_cast<std::int32_t>(body);
  b.position_m = to_vec3(m.position_m);
  b.orientation = to_quatf(m.orientation);
  // One that rests is left out from now on; receivers must not move it on meanwhile.
  if (!moving) return b;
  b.velocity_m_s = to_vec3f(m.velocity_at(m.position_m));
  b.angular_velocity_rad_s = to_vec3f(m.spin_rad_s);
  return b;
}

template <class Page, class Item>
void copy(Page& page, std::vector<Item> Page::*list, const std::vector<Item>& from, std::pair<std::size_t, std::size_t> range) {
  (page.*list).assign(from.begin() + static_cast<std::ptrdiff_t>(range.first), from.begin() + static_cast<std::ptrdiff_t>(range.second));
  page.count = static_cast<std::int32_t>((page.*list).size());
}

}  // namespace

void Snapshots::take_bodies(sync::SimTime now, sync::SimTime pace, const StateSource& source, bool full) {
  bodies_time_ = now;
  full_ = full;
  if (full) {
    full_wanted_ = false;
    last_full_ = pace;
  }
  const bool first = told_.size() != source.bodies.size();
  if (first) told_.assign(source.bodies.begin(), source.bodies.end());
  moved_.resize(source.bodies.size(), 0);
  bodies_.clear();
  for (std::size_t i = 0; i < source.bodies.size(); ++i) {
    const BodyMotion& m = source.bodies[i];
    const bool moving = moves(m, told_[i]);
    // Once more when it has come to rest, so that its last pose is told, at rest.
    if (full || moving || moved_[i]) {
      bodies_.push_back(state_of(i, m, moving));
      told_[i] = m;
    }
    moved_[i] = moving;
  }
  body_pages_ = paged(bodies_, empty_size<world_state_t>());
  sent_bodies_ = 0;
}

void Snapshots::take_contacts(sync::SimTime now, const StateSource& source) {
  contacts_time_ = now;
  source.contacts(contacts_);
  contact_pages_ = paged(contacts_, empty_size<contact_frame_t>());
  sent_contacts_ = 0;
}

void Snapshots::fill(world_state_t& m) {
  m.header.sim_time_ns = sync::to_ns(bodies_time_);
  m.full = full_ ? 1 : 0;
  m.rate_Hz = static_cast<float>(scheduler_.rate_Hz(Lane::kWorld));
  m.page = static_cast<std::int32_t>(sent_bodies_);
  m.pages = static_cast<std::int32_t>(body_pages_.size());
  copy(m, &world_state_t::bodies, bodies_, body_pages_[sent_bodies_++]);
}

void Snapshots::fill(contact_frame_t& m) {
  m.header.sim_time_ns = sync::to_ns(contacts_time_);
  m.group = contact_frame_t::OTHER;
  m.page = static_cast<std::int32_t>(sent_contacts_);
  m.pages = static_cast<std::int32_t>(contact_pages_.size());
  copy(m, &contact_frame_t::contacts, contacts_, contact_pages_[sent_contacts_++]);
}

void Snapshots::tick(sync::SimTime now, sync::SimTime pace, const StateSource& source, const std::function<void(contact_frame_t&)>& send_contacts,
                     const std::function<void(world_state_t&)>& send_world) {
  scheduler_.tick(pace);
  if (scheduler_.due(Lane::kWorld)) {
    take_bodies(now, pace, source, full_wanted_ || !last_full_ || pace - *last_full_ >= kFullPeriod);
    scheduler_.begin(Lane::kWorld, body_pages_.size());
  } else if (full_wanted_) {
    take_bodies(now, pace, source, true);
    scheduler_.begin_urgent_world(body_pages_.size());
  }
  if (scheduler_.due(Lane::kContacts)) {
    take_contacts(now, source);
    scheduler_.begin(Lane::kContacts, contact_pages_.size());
  }
  for (Lane lane = scheduler_.next(); lane != Lane::kNone; lane = scheduler_.next()) {
    if (lane == Lane::kWorld) {
      fill(world_page_);
      send_world(world_page_);
    } else {
      fill(contact_page_);
      send_contacts(contact_page_);
    }
  }
}

}  // namespace tactus::sim
