#include "sim_node/publish/snapshots.h"

#include <algorithm>
#include <tactus/body_state_t.hpp>
#include <tactus/contact_t.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/vectors.h"
#include "sim_node/publish/paging.h"

namespace tactus::sim {
namespace {

// Thresholds of motion, below visual and haptic perception: 20 um and 0.02 degrees since the last publication, or
// these speeds within a snapshot.
constexpr double kMoved_m = 2e-5;
constexpr double kTurned_rad = 4e-4;
constexpr double kMoving_m_s = 1e-3;
constexpr double kTurning_rad_s = 1e-2;

bool moves(const BodyMotion& m, const BodyMotion& published) {
  return (m.position_m - published.position_m).norm() > kMoved_m ||
         m.orientation.angularDistance(published.orientation) > kTurned_rad || m.velocity_m_s.norm() > kMoving_m_s ||
         m.spin_rad_s.norm() > kTurning_rad_s;
}

body_state_t state_of(std::size_t body, const BodyMotion& m, bool moving) {
  body_state_t b{};
  b.body = static_cast<std::int32_t>(body);
  b.position_m = to_vec3(m.position_m);
  b.orientation = to_quatf(m.orientation);
  // A resting body is omitted from later snapshots; velocity 0 prevents receivers from extrapolating it.
  if (!moving) return b;
  b.velocity_m_s = to_vec3f(m.velocity_at(m.position_m));
  b.angular_velocity_rad_s = to_vec3f(m.spin_rad_s);
  return b;
}

// Copies the items of that range, without those for which gone() is true.
template <class Page, class Item, class Gone>
void copy(Page& page, std::vector<Item> Page::*list, const std::vector<Item>& from,
          std::pair<std::size_t, std::size_t> range, const Gone& gone) {
  auto& to = page.*list;
  to.clear();
  for (std::size_t i = range.first; i < range.second; ++i)
    if (!gone(from[i])) to.push_back(from[i]);
  page.count = static_cast<std::int32_t>(to.size());
}

}  // namespace

// The present motion of a body. Bodies computed ahead have the motion at the beginning of their step, one tick ago
// when it has just begun: their velocity extrapolates it, with an error of g h^2 / 2 = 5 um in 1 ms.
const BodyMotion& Snapshots::present(std::size_t body, sync::SimTime now, const StateSource& source) {
  const BodyMotion& m = source.bodies[body];
  const LookAhead* a = source.look_ahead;
  const auto in = [body](std::span<const int> list) {
    return std::binary_search(list.begin(), list.end(), static_cast<int>(body));
  };
  if (!a || !(in(a->bodies) || in(a->waiting))) return m;
  present_ = m;
  if (a->held) {
    present_.velocity_m_s = present_.spin_rad_s = Eigen::Vector3d::Zero();
    return present_;
  }
  const double h_s = sync::to_seconds(now - a->begins), angle = m.spin_rad_s.norm() * h_s;
  present_.position_m += h_s * m.velocity_at(m.position_m);
  present_.centre_m += h_s * m.velocity_m_s;
  if (angle > 0) present_.orientation = Eigen::AngleAxisd(angle, m.spin_rad_s.normalized()) * m.orientation;
  return present_;
}

void Snapshots::add_present(std::size_t body, const BodyMotion& m, bool always) {
  const bool moving = moves(m, last_published_[body]);
  // Published once more at rest, so that receivers get the final pose.
  if (always || moving || moved_[body]) {
    bodies_.items.push_back(state_of(body, m, moving));
    last_published_[body] = m;
  }
  moved_[body] = moving;
}

// A body that was not computed ahead before, or rested, is also published at the current step, where interpolation
// begins.
void Snapshots::add_ahead(std::size_t body, const BodyMotion& m, const BodyMotion& now, bool always) {
  const bool moving = moves(m, last_published_[body]);
  if (moving && !(ahead_[body] && moved_[body]))
    bodies_.items.push_back(state_of(body, now, moves(now, last_published_[body])));
  if (always || moving || moved_[body]) {
    bodies_ahead_.items.push_back(state_of(body, m, moving));
    last_published_[body] = m;
  }
  moved_[body] = moving;
}

void Snapshots::take_bodies(sync::SimTime now, sync::SimTime pace, const StateSource& source, bool full,
                            bool with_ahead) {
  const LookAhead* a = source.look_ahead;
  bodies_.time = now;
  bodies_ahead_.time = a ? a->time : now;
  full_ = full;
  if (full) {
    full_requested_ = false;
    last_full_ = pace;
  }
  const bool first = last_published_.size() != source.bodies.size();
  if (first) last_published_.assign(source.bodies.begin(), source.bodies.end());
  moved_.resize(source.bodies.size(), 0);
  bodies_.items.clear();
  bodies_ahead_.items.clear();
  for (std::size_t i = 0, next = 0; i < source.bodies.size(); ++i) {
    const bool is_ahead = a && next < a->bodies.size() && a->bodies[next] == static_cast<int>(i);
    const BodyMotion* predicted = is_ahead ? &a->motions[next++] : nullptr;
    if (!is_ahead || a->held) {
      add_present(i, present(i, now, source), full || (a && repeat_until_[i] > pace));
      if (a) ahead_[i] = 0;
    } else if (with_ahead) {
      add_ahead(i, *predicted, present(i, now, source), full);
      ahead_[i] = 1;
    }
  }
  gone_.assign(gone_.size(), 0);
  bodies_.pages.clear();
  bodies_ahead_.pages.clear();
  if (!bodies_ahead_.items.empty()) bodies_ahead_.pages = paged(bodies_ahead_.items, empty_size<world_state_t>());
  if (!bodies_.items.empty() || bodies_ahead_.pages.empty())
    bodies_.pages = paged(bodies_.items, empty_size<world_state_t>());
  sent_bodies_ = 0;
}

void Snapshots::take_contacts(sync::SimTime now, const StateSource& source) {
  contacts_.time = now;
  source.contacts(contacts_.items);
  contacts_.pages = paged(contacts_.items, empty_size<contact_frame_t>());
  contacts_ahead_.pages.clear();
  sent_contacts_ = 0;
  if (!source.look_ahead) return;
  contacts_ahead_.time = source.look_ahead->held ? now : source.look_ahead->time;
  source.look_ahead->contacts(contacts_ahead_.items);
  contacts_ahead_.pages = paged(contacts_ahead_.items, empty_size<contact_frame_t>());
}

void Snapshots::fill(world_state_t& m) {
  const bool now = sent_bodies_ < bodies_.pages.size();
  const Part<body_state_t>& part = now ? bodies_ : bodies_ahead_;
  const std::size_t page = now ? sent_bodies_ : sent_bodies_ - bodies_.pages.size();
  ++sent_bodies_;
  m.header.sim_time_ns = sync::to_ns(part.time);
  m.group = now ? world_state_t::NOW : world_state_t::AHEAD;
  m.full = full_ ? 1 : 0;
  m.rate_Hz = static_cast<float>(scheduler_.rate_Hz(Lane::kWorld));
  m.page = static_cast<std::int32_t>(page);
  m.pages = static_cast<std::int32_t>(part.pages.size());
  copy(m, &world_state_t::bodies, part.items, part.pages[page],
       [&](const body_state_t& b) { return !now && gone_[static_cast<std::size_t>(b.body)] != 0; });
}

void Snapshots::fill(contact_frame_t& m) {
  // Pages of contacts ahead come first, so that a contact that changes groups is in one of the two at every instant.
  const bool now = sent_contacts_ >= contacts_ahead_.pages.size();
  const Part<contact_t>& part = now ? contacts_ : contacts_ahead_;
  const std::size_t page = now ? sent_contacts_ - contacts_ahead_.pages.size() : sent_contacts_;
  ++sent_contacts_;
  m.header.sim_time_ns = sync::to_ns(part.time);
  m.group = now ? contact_frame_t::OTHER : contact_frame_t::AHEAD;
  m.page = static_cast<std::int32_t>(page);
  m.pages = static_cast<std::int32_t>(part.pages.size());
  // Includes contacts of promoted bodies: they still touch, and the next snapshot updates their force.
  copy(m, &contact_frame_t::contacts, part.items, part.pages[page], [](const contact_t&) { return false; });
}

// Updates the state of the bodies computed ahead. paused: the world is paused, and the data of this tick have been
// published before.
void Snapshots::update_ahead(const LookAhead& look_ahead, std::size_t bodies, sync::SimTime pace, bool paused) {
  ahead_.resize(bodies, 0);
  gone_.resize(bodies, 0);
  repeat_until_.resize(bodies, sync::SimTime::min());
  moved_.resize(bodies, 0);
  if ((look_ahead.fresh && !paused) || (look_ahead.held && !held_)) bodies_pending_ = contacts_pending_ = true;
  held_ = look_ahead.held;
  // Drop a body that left the haptic group before its promotion was published.
  std::erase_if(promoted_, [&](int body) {
    return std::binary_search(look_ahead.bodies.begin(), look_ahead.bodies.end(), body);
  });
  if (paused) return;
  for (const int body : look_ahead.promoted) {
    const auto i = static_cast<std::size_t>(body);
    ahead_[i] = 0;
    moved_[i] = 1;
    gone_[i] = 1;
    repeat_until_[i] = pace + kRepeatPromoted;
    if (std::find(promoted_.begin(), promoted_.end(), body) == promoted_.end()) promoted_.push_back(body);
  }
}

void Snapshots::publish_promoted(sync::SimTime now, const StateSource& source,
                              const std::function<void(world_state_t&)>& send) {
  static const std::size_t per_page = (channels::kMaxMessageBytes - empty_size<world_state_t>()) /
                                      static_cast<std::size_t>(body_state_t{}._getEncodedSizeNoHash());
  std::size_t pages = 0;
  while (pages * per_page < promoted_.size() && scheduler_.take_extra()) ++pages;
  const std::size_t published = std::min(promoted_.size(), pages * per_page);
  world_state_t& m = world_page_;
  for (std::size_t page = 0; page < pages; ++page) {
    m.header.sim_time_ns = sync::to_ns(now);
    m.group = world_state_t::PROMOTED;
    m.full = 0;
    m.rate_Hz = static_cast<float>(scheduler_.rate_Hz(Lane::kWorld));
    m.page = static_cast<std::int32_t>(page);
    m.pages = static_cast<std::int32_t>(pages);
    m.bodies.clear();
    for (std::size_t i = page * per_page; i < std::min(published, (page + 1) * per_page); ++i) {
      const auto body = static_cast<std::size_t>(promoted_[i]);
      const BodyMotion& motion = present(body, now, source);
      m.bodies.push_back(state_of(body, motion, last_published_.size() <= body || moves(motion, last_published_[body])));
    }
    m.count = static_cast<std::int32_t>(m.bodies.size());
    send(m);
  }
  promoted_.erase(promoted_.begin(), promoted_.begin() + static_cast<std::ptrdiff_t>(published));
}

void Snapshots::take_due(sync::SimTime now, sync::SimTime pace, const StateSource& source) {
  if (scheduler_.due(Lane::kWorld)) {
    take_bodies(now, pace, source, full_requested_ || !last_full_ || pace - *last_full_ >= kFullPeriod, false);
    scheduler_.begin(Lane::kWorld, bodies_.pages.size());
  } else if (full_requested_) {
    take_bodies(now, pace, source, true, false);
    scheduler_.begin_urgent_world(bodies_.pages.size());
  }
  if (scheduler_.due(Lane::kContacts)) {
    take_contacts(now, source);
    scheduler_.begin(Lane::kContacts, contacts_.pages.size());
  }
}

void Snapshots::take_due_ahead(sync::SimTime now, sync::SimTime pace, const StateSource& source) {
  const auto ready = [&](Lane lane, bool pending, sync::SimTime taken) {
    return scheduler_.free(lane) && (pending || (scheduler_.due(lane) && pace - taken >= kMaxStepGap));
  };
  const bool takes = ready(Lane::kWorld, bodies_pending_, taken_bodies_);
  if (takes || full_requested_) {
    const bool full = full_requested_ || !last_full_ || pace - *last_full_ >= kFullPeriod;
    take_bodies(now, pace, source, full, bodies_pending_ || full);
    const std::size_t pages = bodies_.pages.size() + bodies_ahead_.pages.size();
    takes ? scheduler_.begin(Lane::kWorld, pages) : scheduler_.begin_urgent_world(pages);
    bodies_pending_ = false;
    taken_bodies_ = pace;
  }
  if (ready(Lane::kContacts, contacts_pending_, taken_contacts_)) {
    take_contacts(now, source);
    scheduler_.begin(Lane::kContacts, contacts_.pages.size() + contacts_ahead_.pages.size());
    contacts_pending_ = false;
    taken_contacts_ = pace;
  }
}

void Snapshots::tick(sync::SimTime now, sync::SimTime pace, const StateSource& source,
                     const std::function<void(contact_frame_t&)>& send_contacts,
                     const std::function<void(world_state_t&)>& send_world) {
  scheduler_.tick(pace);
  if (source.look_ahead) {
    update_ahead(*source.look_ahead, source.bodies.size(), pace, last_now_ == now);
    last_now_ = now;
    publish_promoted(now, source, send_world);
    take_due_ahead(now, pace, source);
  } else {
    take_due(now, pace, source);
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
