#include "sim_node/collision/contact_tracker.h"

#include <algorithm>
#include <cmath>

#include "lcmtypes/vectors.h"

namespace tactus::sim {

using Eigen::Vector3d;

namespace {

// Another hit needs the surfaces to have closed slower than this part of the threshold in between.
constexpr double kRearm = 0.5;
// The rolling velocity is a difference of two places: smoothed over so much time, s; a contact point that jumps further
// than this beyond the motion of the surfaces did not roll, m.
constexpr double kRollingTime_s = 0.005;
constexpr double kJump_m = 0.005;

Vector3d centre_of(const Manifold& c) {
  Vector3d sum = Vector3d::Zero();
  for (const ManifoldPoint& p : c.used()) sum += p.point_m;
  return sum / std::max(1, c.count);
}

Vector3d tangential(const Vector3d& v, const Vector3d& n) { return v - v.dot(n) * n; }

const BodyMotion& at(std::span<const BodyMotion> bodies, int i) { return bodies[static_cast<std::size_t>(i)]; }

}  // namespace

ContactTracker::ContactTracker(std::vector<SurfaceTraits> surfaces, const Settings& settings, Ids& ids)
    : surfaces_(std::move(surfaces)), settings_(settings), step_(sync::from_seconds(settings.step_s)), ids_(ids) {}

ContactTracker::Approach ContactTracker::approach(const Manifold& c, std::span<const BodyMotion> bodies) const {
  Approach best;
  for (const ManifoldPoint& p : c.used()) {
    const Vector3d relative = at(bodies, c.body_b).velocity_at(p.point_m) - at(bodies, c.body_a).velocity_at(p.point_m);
    const double speed = -relative.dot(p.normal);
    if (!best.point || speed > best.speed_m_s) best = {speed, &p};
  }
  return best;
}

double ContactTracker::curvature_of(const Manifold& c, const ManifoldPoint& p, std::span<const BodyMotion> bodies) const {
  const ContactKind kind = kind_of(c);
  return curvature(surfaces_[static_cast<std::size_t>(c.shape_a)], kind, at(bodies, c.body_a).to_body(p.point_m), p.triangle_a) +
         curvature(surfaces_[static_cast<std::size_t>(c.shape_b)], kind, at(bodies, c.body_b).to_body(p.point_m), p.triangle_b);
}

void ContactTracker::emit(LiveContact& c, std::int8_t kind, sync::SimTime when, const Approach& approach,
                          std::span<const BodyMotion> bodies) {
  const Manifold& m = c.manifold;
  const ManifoldPoint& p = approach.point ? *approach.point : m.points[0];
  when = std::max(when, c.last_event);
  c.last_event = when;
  contact_event_t& e = events_->emplace_back();
  e.event_id = ids_.fresh();
  e.contact_id = c.id;
  e.kind = kind;
  e.time_ns = sync::to_ns(when);
  e.body_a = m.body_a;
  e.body_b = m.body_b;
  e.material_a = surfaces_[static_cast<std::size_t>(m.shape_a)].material;
  e.material_b = surfaces_[static_cast<std::size_t>(m.shape_b)].material;
  e.tool = -1;
  e.point_m = to_vec3f(p.point_m);
  e.normal = to_vec3f(p.normal);
  e.approach_speed_m_s = static_cast<float>(std::max(0.0, approach.speed_m_s));
  e.effective_mass_kg = static_cast<float>(effective_mass(at(bodies, m.body_a), at(bodies, m.body_b), p.point_m, p.normal));
  e.curvature_1_m = static_cast<float>(curvature_of(m, p, bodies));
}

// Takes the newest manifold as the state of the contact.
void ContactTracker::remember(LiveContact& c, const Manifold& m, std::span<const BodyMotion> bodies, bool rolls) {
  const BodyMotion &a = at(bodies, m.body_a), &b = at(bodies, m.body_b);
  const Vector3d place = centre_of(m), n = m.points[0].normal;
  const Vector3d surfaces = 0.5 * (a.velocity_at(place) + b.velocity_at(place));
  Vector3d rolling = Vector3d::Zero();
  if (rolls && kind_of(m) != ContactKind::kSurface) {
    const Vector3d beyond = tangential(place - c.place_m - surfaces * settings_.step_s, n);
    if (beyond.norm() < kJump_m) rolling = beyond / settings_.step_s;
  }
  c.rolling_m_s += (rolling - c.rolling_m_s) * std::min(1.0, settings_.step_s / kRollingTime_s);
  c.manifold = m;
  c.place_m = place;
  c.touching = true;
  c.gap_m = 0;
  const ManifoldPoint& p = m.points[0];
  c.a_body_m = a.to_body(p.point_m + 0.5 * p.depth_m * p.normal);
  c.b_body_m = b.to_body(p.point_m - 0.5 * p.depth_m * p.normal);
}

// A hit when the surfaces close fast enough. The impact was inside the step: where the overlap began.
void ContactTracker::meet(LiveContact& c, bool is_new, std::span<const BodyMotion> bodies) {
  const Approach fast = approach(c.manifold, bodies);
  const double since_s =
      fast.speed_m_s > 0 ? std::clamp(fast.point->depth_m / fast.speed_m_s, 0.0, settings_.step_s) : 0;
  const sync::SimTime when = now_ - sync::from_seconds(since_s);
  if (is_new) emit(c, contact_event_t::BEGIN, when, fast, bodies);
  const bool rested = !c.has_hit || now_ - c.last_hit >= sync::from_seconds(settings_.hit_interval_s);
  if (c.armed && rested && fast.speed_m_s > settings_.hit_speed_m_s) {
    emit(c, contact_event_t::HIT, when, fast, bodies);
    c.armed = false;
    c.has_hit = true;
    c.last_hit = now_;
  } else if (fast.speed_m_s < kRearm * settings_.hit_speed_m_s) {
    c.armed = true;
  }
}

void ContactTracker::begin(const Manifold& m, std::span<const BodyMotion> bodies) {
  LiveContact& c = next_.emplace_back();
  c = LiveContact{};
  c.id = ids_.fresh();
  remember(c, m, bodies, false);
  meet(c, true, bodies);
}

void ContactTracker::keep(LiveContact& c, const Manifold& m, std::span<const BodyMotion> bodies) {
  remember(c, m, bodies, c.touching);
  meet(c, false, bodies);
  next_.push_back(c);
}

bool ContactTracker::part(LiveContact& c, std::span<const BodyMotion> bodies) {
  const Manifold& m = c.manifold;
  const BodyMotion &a = at(bodies, m.body_a), &b = at(bodies, m.body_b);
  const Vector3d on_a = a.to_world(c.a_body_m), on_b = b.to_world(c.b_body_m), n = m.points[0].normal;
  c.gap_m = (on_b - on_a).dot(n);
  if (c.touching) {
    const double opening = (b.velocity_at(on_b) - a.velocity_at(on_a)).dot(n);
    const double since_s = opening > 0 ? std::clamp(c.gap_m / opening, 0.0, settings_.step_s) : settings_.step_s;
    c.apart_since = now_ - sync::from_seconds(since_s);
    c.touching = false;
  }
  c.armed = true;
  const bool ended = c.gap_m > settings_.contact_end_gap_m ||
                     now_ - c.apart_since > sync::from_seconds(settings_.contact_end_time_s);
  if (ended) emit(c, contact_event_t::END, c.apart_since, {}, bodies);
  return ended;
}

void ContactTracker::update(sync::SimTime now, std::span<const BodyMotion> bodies, std::span<const Manifold> contacts,
                            std::span<const Manifold> solved, std::vector<contact_event_t>& events) {
  now_ = now;
  events_ = &events;
  // What the step did to the contacts that it began with.
  auto force = solved.begin();
  for (LiveContact& c : live_) {
    while (force != solved.end() && force->before(c.manifold)) ++force;
    c.normal_force_N = 0;
    if (force == solved.end() || c.manifold.before(*force)) continue;
    for (const ManifoldPoint& p : force->used()) c.normal_force_N += p.normal_force_N;
    c.impulse_N_s += c.normal_force_N * settings_.step_s;
  }
  // Both lists are ordered: one pass finds what began, stayed and parted.
  next_.clear();
  auto old = live_.begin();
  const auto part_until = [&](const Manifold* limit) {
    for (; old != live_.end() && (!limit || old->manifold.before(*limit)); ++old)
      if (!part(*old, bodies)) next_.push_back(*old);
  };
  for (const Manifold& m : contacts) {
    part_until(&m);
    if (old != live_.end() && !m.before(old->manifold))
      keep(*old++, m, bodies);
    else
      begin(m, bodies);
  }
  part_until(nullptr);
  std::swap(live_, next_);
}

void ContactTracker::describe(const LiveContact& c, std::span<const BodyMotion> bodies, contact_t& out) const {
  const Manifold& m = c.manifold;
  const SurfaceTraits &sa = surfaces_[static_cast<std::size_t>(m.shape_a)], &sb = surfaces_[static_cast<std::size_t>(m.shape_b)];
  const BodyMotion &a = at(bodies, m.body_a), &b = at(bodies, m.body_b);
  const ManifoldPoint& deepest = m.points[0];
  const ContactKind kind = kind_of(m);
  out.contact_id = c.id;
  out.kind = static_cast<std::int8_t>(kind);
  out.body_a = m.body_a;
  out.body_b = m.body_b;
  out.material_a = sa.material;
  out.material_b = sb.material;
  out.tool = -1;
  out.normal = to_vec3f(deepest.normal);
  out.depth_m = static_cast<float>(c.touching ? deepest.depth_m : -c.gap_m);
  out.area_m2 = static_cast<float>(contact_area(m, kind, c.normal_force_N, curvature_of(m, deepest, bodies),
                                                sa.compliance_1_Pa + sb.compliance_1_Pa));
  out.normal_force_N = static_cast<float>(c.normal_force_N);
  out.impulse_N_s = static_cast<float>(c.impulse_N_s);
  out.sliding_velocity_m_s =
      to_vec3f(tangential(b.velocity_at(c.place_m) - a.velocity_at(c.place_m), deepest.normal));
  out.rolling_velocity_m_s = to_vec3f(c.rolling_m_s);
  out.points.clear();
  for (const ManifoldPoint& p : m.used()) {
    const Vector3d on_a = p.point_m + 0.5 * p.depth_m * p.normal, on_b = p.point_m - 0.5 * p.depth_m * p.normal;
    contact_point_t& q = out.points.emplace_back();
    q.a_world_m = to_vec3f(on_a);
    q.b_world_m = to_vec3f(on_b);
    q.a_body_m = to_vec3f(a.to_body(on_a));
    q.b_body_m = to_vec3f(b.to_body(on_b));
  }
  out.point_count = static_cast<std::int8_t>(out.points.size());
}

}  // namespace tactus::sim
