#include "sim_node/contacts/contact_tracker.h"

#include <algorithm>
#include <tactus/contact_point_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/model/behaviour_model.h"

namespace tactus::sim {

using Eigen::Vector3d;

namespace {

// Re-arms the hit when the closing speed falls below this share of the threshold.
constexpr double kRearm = 0.5;
// Time constant of the low-pass filter of the rolling velocity, which is a difference of two positions, s. A contact
// point that jumps further than kJump_m, relative to the motion of the surfaces, did not roll, m.
constexpr double kRollingTime_s = 0.005;
constexpr double kJump_m = 0.005;
// Surfaces with a gap below kTouch_m touch. Design value: twice the residual that the solver leaves between
// resting surfaces (impulse::ContactLaw). Touching surfaces separate when the gap exceeds kSeparationGap_m.
constexpr double kTouch_m = 20e-6, kSeparationGap_m = 60e-6;

Vector3d centre_of(const Manifold& c) {
  Vector3d sum = Vector3d::Zero();
  for (const ManifoldPoint& p : c.used()) sum += p.point_m;
  return sum / std::max(1, c.count);
}

double deepest(const Manifold& c) {
  double depth = c.points[0].depth_m;
  for (const ManifoldPoint& p : c.used()) depth = std::max(depth, p.depth_m);
  return depth;
}

// Keeps the points that satisfy `keep`, or all points when none does.
template <class Keep>
void take_points(const Manifold& c, Keep keep, Manifold& out) {
  out = c;
  if (std::none_of(c.used().begin(), c.used().end(), keep)) return;
  out.count = 0;
  for (const ManifoldPoint& p : c.used())
    if (keep(p)) out.points[static_cast<std::size_t>(out.count++)] = p;
}

Vector3d tangential(const Vector3d& v, const Vector3d& n) { return v - v.dot(n) * n; }

const BodyMotion& at(std::span<const BodyMotion> bodies, int i) { return bodies[static_cast<std::size_t>(i)]; }

}  // namespace

ContactTracker::ContactTracker(std::vector<SurfaceTraits> surfaces, const Settings& settings, Ids& ids)
    : surfaces_(std::move(surfaces)),
      settings_(settings),
      contact_distance_m_(contact_distance_m(settings)),
      ids_(ids) {}

// The point with the highest closing speed.
ContactTracker::Closing ContactTracker::closing(const Manifold& c, std::span<const BodyMotion> bodies) const {
  const BodyMotion &a = at(bodies, c.body_a), &b = at(bodies, c.body_b);
  Closing fastest;
  for (const ManifoldPoint& p : c.used()) {
    const double speed = (a.velocity_at(p.point_m) - b.velocity_at(p.point_m)).dot(p.normal);
    if (!fastest.point || speed > fastest.speed_m_s) fastest = {&p, speed};
  }
  return fastest;
}

ContactTracker::Approach ContactTracker::approach(const Manifold& c, std::span<const BodyMotion> bodies) const {
  const auto [point, speed_m_s] = closing(c, bodies);
  return {.speed_m_s = speed_m_s,
          .mass_kg = effective_mass(at(bodies, c.body_a), at(bodies, c.body_b), point->point_m, point->normal),
          .curvature_1_m = curvature_of(c, *point, bodies),
          .position_m = point->point_m,
          .normal = point->normal};
}

double ContactTracker::curvature_of(const Manifold& c, const ManifoldPoint& p, std::span<const BodyMotion> bodies) const {
  const ContactKind kind = kind_of(c);
  return curvature(surfaces_[static_cast<std::size_t>(c.shape_a)], kind, at(bodies, c.body_a).to_body(p.point_m), p.triangle_a) +
         curvature(surfaces_[static_cast<std::size_t>(c.shape_b)], kind, at(bodies, c.body_b).to_body(p.point_m), p.triangle_b);
}

ContactTracker::Approach ContactTracker::approach(const Manifold& c, const Impact& impact) const {
  const ContactKind kind = kind_of(c);
  const auto curved = [&](int shape, const Vector3d& in_body, int triangle) {
    return curvature(surfaces_[static_cast<std::size_t>(shape)], kind, in_body, triangle);
  };
  return {.speed_m_s = impact.speed_m_s,
          .mass_kg = impact.effective_mass_kg,
          .curvature_1_m = curved(c.shape_a, impact.a_body_m, impact.triangle_a) +
                           curved(c.shape_b, impact.b_body_m, impact.triangle_b),
          .position_m = impact.position_m,
          .normal = impact.normal};
}

void ContactTracker::emit(LiveContact& c, std::int8_t kind, sync::SimTime when, const Approach& status) {
  const Manifold& m = c.manifold;
  when = std::max(when, c.last_event);
  c.last_event = when;
  contact_event_t& e = events_->emplace_back();
  e.event_id = ids_.next_id();
  e.contact_id = c.id;
  e.kind = kind;
  e.time_ns = sync::to_ns(when);
  e.body_a = m.body_a;
  e.body_b = m.body_b;
  e.material_a = surfaces_[static_cast<std::size_t>(m.shape_a)].material;
  e.material_b = surfaces_[static_cast<std::size_t>(m.shape_b)].material;
  e.tool = -1;
  e.point_m = to_vec3(status.position_m);
  e.normal = to_vec3f(status.normal);
  e.approach_speed_m_s = static_cast<float>(std::max(0.0, status.speed_m_s));
  e.effective_mass_kg = static_cast<float>(status.mass_kg);
  e.curvature_1_m = static_cast<float>(status.curvature_1_m);
}

void ContactTracker::report(LiveContact& c, std::int8_t kind, sync::SimTime when, std::span<const BodyMotion> bodies,
                          std::vector<contact_event_t>& events) {
  events_ = &events;
  emit(c, kind, when, approach(c.manifold, bodies));
}

// Updates the state of a contact from its newest manifold.
void ContactTracker::store_state(LiveContact& c, std::span<const BodyMotion> bodies, bool rolls) {
  const Manifold& m = c.manifold;
  const BodyMotion &a = at(bodies, m.body_a), &b = at(bodies, m.body_b);
  const Vector3d place = centre_of(m), n = m.points[0].normal;
  const Vector3d surfaces = 0.5 * (a.velocity_at(place) + b.velocity_at(place));
  Vector3d rolling = Vector3d::Zero();
  if (rolls && kind_of(m) != ContactKind::kSurface) {
    const Vector3d beyond = tangential(place - c.position_m - surfaces * step_s_, n);
    if (beyond.norm() < kJump_m) rolling = beyond / step_s_;
  }
  c.rolling_m_s += (rolling - c.rolling_m_s) * std::min(1.0, step_s_ / kRollingTime_s);
  c.position_m = place;
  c.touching = true;
  c.gap_m = 0;
  const ManifoldPoint& p = m.points[0];
  c.a_body_m = a.to_body(p.point_m + 0.5 * p.depth_m * p.normal);
  c.b_body_m = b.to_body(p.point_m - 0.5 * p.depth_m * p.normal);
}

template <class DescribeApproach>
void ContactTracker::begin_or_hit(LiveContact& c, bool is_new, sync::SimTime when, double speed_m_s, DescribeApproach describe) {
  if (is_new) emit(c, contact_event_t::BEGIN, when, describe());
  const bool rested = !c.has_hit || now_ - c.last_hit >= sync::from_seconds(settings_.hit_interval_s);
  if (c.armed && rested && speed_m_s > settings_.hit_speed_m_s) {
    emit(c, contact_event_t::HIT, when, describe());
    c.armed = false;
    c.has_hit = true;
    c.last_hit = now_;
  } else if (speed_m_s < kRearm * settings_.hit_speed_m_s) {
    c.armed = true;
  }
}

bool ContactTracker::separate(LiveContact& c, const Manifold* near, const Manifold* struck, std::span<const BodyMotion> bodies) {
  const Manifold& m = c.manifold;
  const BodyMotion &a = at(bodies, m.body_a), &b = at(bodies, m.body_b);
  const Vector3d on_a = a.to_world(c.a_body_m), on_b = b.to_world(c.b_body_m), n = m.points[0].normal;
  c.gap_m = (near ? -deepest(*near) : (on_b - on_a).dot(n)) - contact_distance_m_;
  if (c.touching || struck) {
    const double opening = (b.velocity_at(on_b) - a.velocity_at(on_a)).dot(n);
    const double since_s = struck        ? step_s_ - struck->impact.last_s
                           : opening > 0 ? std::clamp(c.gap_m / opening, 0.0, step_s_)
                                         : step_s_;
    c.separated_since = now_ - sync::from_seconds(since_s);
    c.touching = false;
  }
  c.armed = true;
  const bool ended = c.gap_m > settings_.contact_end_gap_m ||
                     now_ - c.separated_since > sync::from_seconds(settings_.contact_end_time_s);
  if (ended) {
    Approach status = approach(m, bodies);
    status.speed_m_s = 0;
    status.position_m = on_a;
    emit(c, contact_event_t::END, c.separated_since, status);
  }
  return ended;
}

// Processes one pair of shapes in one step. before: its previous state; near: the manifold at the end of the step;
// solved: the solver's result for the step.
void ContactTracker::update_pair(const LiveContact* before, const Manifold* near, const Manifold* solved,
                            std::span<const BodyMotion> bodies) {
  const Manifold* struck = solved && solved->impact.count > 0 ? solved : nullptr;
  const bool touched = before && before->touching;
  const double within = contact_distance_m_ + (touched ? kSeparationGap_m : kTouch_m);
  const bool touches = near && -deepest(*near) <= within;
  if (!before && !struck && !touches) return;
  LiveContact& c = next_.emplace_back();
  if (before)
    c = *before;
  else
    c.id = ids_.next_id();
  c.normal_force_N = 0;
  if (solved) {
    for (const ManifoldPoint& p : solved->used()) c.normal_force_N += p.normal_force_N;
    c.impulse_N_s += c.normal_force_N * step_s_;
  }
  if (struck) {
    const Impact& i = struck->impact;
    if (!before) c.position_m = i.position_m;
    take_points(*struck, [](const ManifoldPoint& p) { return p.normal_force_N > 0; }, c.manifold);
    c.a_body_m = i.a_body_m, c.b_body_m = i.b_body_m;
    // The solver reports each impact once, also those of a body that rattles and never stays slow for a step.
    c.armed = true;
    begin_or_hit(c, !before, now_ - step_ + sync::from_seconds(i.first_s), i.speed_m_s, [&] { return approach(c.manifold, i); });
  }
  if (touches) {
    const double far = contact_distance_m_ + kSeparationGap_m;
    take_points(*near, [&](const ManifoldPoint& p) { return -p.depth_m <= far; }, c.manifold);
    store_state(c, bodies, touched);
    if (struck) return;
    // The impact was within the step, where the overlap began.
    const auto [point, speed_m_s] = closing(c.manifold, bodies);
    const double depth_m = std::max(0.0, point->depth_m + contact_distance_m_);
    const double since_s = speed_m_s > 0 ? std::clamp(depth_m / speed_m_s, 0.0, step_s_) : 0;
    begin_or_hit(c, !before, now_ - sync::from_seconds(since_s), speed_m_s, [&] { return approach(c.manifold, bodies); });
  } else if (separate(c, near, struck, bodies)) {
    next_.pop_back();
  }
}

void ContactTracker::update(sync::SimTime now, sync::Nanoseconds step, std::span<const BodyMotion> bodies,
                            std::span<const Manifold> contacts, std::span<const Manifold> solved,
                            std::vector<contact_event_t>& events) {
  now_ = now;
  step_ = step;
  step_s_ = sync::to_seconds(step);
  events_ = &events;
  next_.clear();
  // All three lists are ordered: one merge pass over their pairs.
  auto old = live_.cbegin();
  auto near = contacts.begin(), met = solved.begin();
  while (true) {
    const Manifold* first = nullptr;
    const auto earlier = [&](const Manifold& m) {
      if (!first || m.before(*first)) first = &m;
    };
    if (old != live_.cend()) earlier(old->manifold);
    if (near != contacts.end()) earlier(*near);
    if (met != solved.end()) earlier(*met);
    if (!first) break;
    const auto same = [&](const Manifold& m) { return !m.before(*first) && !first->before(m); };
    const LiveContact* before = old != live_.cend() && same(old->manifold) ? &*old : nullptr;
    const Manifold* at_end = near != contacts.end() && same(*near) ? &*near : nullptr;
    const Manifold* in_step = met != solved.end() && same(*met) ? &*met : nullptr;
    update_pair(before, at_end, in_step, bodies);
    if (before) ++old;
    if (at_end) ++near;
    if (in_step) ++met;
  }
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
  out.depth_m = static_cast<float>(c.touching ? deepest.depth_m + contact_distance_m_ : -c.gap_m);
  out.area_m2 = static_cast<float>(contact_area(m, kind, c.normal_force_N, curvature_of(m, deepest, bodies),
                                                sa.compliance_1_Pa + sb.compliance_1_Pa));
  out.normal_force_N = static_cast<float>(c.normal_force_N);
  out.impulse_N_s = static_cast<float>(c.impulse_N_s);
  out.sliding_velocity_m_s =
      to_vec3f(tangential(b.velocity_at(c.position_m) - a.velocity_at(c.position_m), deepest.normal));
  out.rolling_velocity_m_s = to_vec3f(c.rolling_m_s);
  out.points.clear();
  // A message has room for the points of one face: the first, which is the nearest.
  for (const ManifoldPoint& p : m.used().first(std::min(m.used().size(), std::size_t{kMaxFacePoints}))) {
    const Vector3d on_a = p.point_m + 0.5 * p.depth_m * p.normal, on_b = p.point_m - 0.5 * p.depth_m * p.normal;
    contact_point_t& q = out.points.emplace_back();
    q.a_world_m = to_vec3(on_a);
    q.b_world_m = to_vec3(on_b);
    q.a_body_m = to_vec3(a.to_body(on_a));
    q.b_body_m = to_vec3(b.to_body(on_b));
  }
  out.point_count = static_cast<std::int8_t>(out.points.size());
}

}  // namespace tactus::sim
