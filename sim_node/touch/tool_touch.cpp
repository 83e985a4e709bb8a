#include "sim_node/touch/tool_touch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tactus/contact_point_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/touch_plane_t.hpp>

#include "lcmtypes/bump.h"
#include "lcmtypes/pointing.h"
#include "lcmtypes/vectors.h"
#include "sim_node/model/tool_shape.h"
#include "sync/resampling/sample_status.h"

namespace tactus::sim {

using Eigen::Vector3d;
using sync::SimTime;

namespace {

// A plane belongs to the surface tracked before when its normal has turned by less than this in a step.
const double kSameSurface = std::cos(60 * M_PI / 180);
// Margin of a shaped tool over a triangle mesh, m. All triangle pairs within it are checked, so the time grows with
// its square. Design: the distance that a proxy may move on two models (haptic setting proxy_reach), at rest.
constexpr double kMeshMargin_m = 0.003;
// For a shaped tool, the point on the tool must also be within this distance of the previous one. Design: a rolling
// contact moves by less in a step, and the corners of a handheld object are further apart.
constexpr double kSameFeature_m = 0.004;
// A surface out of reach is dropped after this time, unless it is touched.
constexpr sync::Nanoseconds kTrackingTimeout{50'000'000};
// Maximum back-dating of a begin: the age at which a message counts as lost.
constexpr sync::Nanoseconds kMaxMessageAge{20'000'000};
constexpr double kRounding_N = 1e-4;  // smaller forces are rounding
// A tool that has rendered a late model counts as late for this time: losses in bursts do not change the model each time.
// Design.
constexpr sync::Nanoseconds kLateFor{1'000'000'000};
// Places in a model that far fixed surfaces may fill: one page (touch_model_t.plane_count).
constexpr std::size_t kMaxWithFar = 7;
// Rounding of positions in the world, m.
constexpr double kRounding_m = 1e-9;

sync::Nanoseconds ns(double s) { return sync::from_seconds(s); }

bool is_meshed(ShapeKind kind) { return kind == ShapeKind::kMesh || kind == ShapeKind::kHeightfield; }

}  // namespace

ToolTouch::ToolTouch(const WorldDef& world, int tool, const Settings& settings, Ids& ids, MeshTrees& trees)
    : tool_(tool), settings_(settings), ids_(ids) {
  const tool_def_t& def = world.tools[static_cast<std::size_t>(tool)];
  tool_body_ = def.body;
  tool_material_ = def.material;
  const bool shaped = is_shaped(def);
  radius_m_ = shaped ? 0 : def.radius_m;
  bound_m_ = def.radius_m;
  tool_mass_kg_ = def.mass_kg;
  double own_compliance = 1 / settings.default_youngs_modulus_Pa;
  if (tool_material_ >= 0) {
    const material_def_t& m = world.materials[static_cast<std::size_t>(tool_material_)];
    tool_static_friction_ = m.friction_static, tool_dynamic_friction_ = m.friction_dynamic;
    own_compliance = (1 - m.poissons_ratio * m.poissons_ratio) / m.youngs_modulus_Pa;
  }
  const std::vector<SurfaceTraits> traits = surface_traits(world, settings);
  const bool points = only_points(def, world.lights);
  if (shaped && !points) shape_.emplace(world, tool, settings, trees);
  for (std::size_t i = 0; i < world.shapes.size() && !points; ++i) {
    const ShapeDef& s = world.shapes[i];
    if (world.bodies[static_cast<std::size_t>(s.body)].tool >= 0) continue;
    ClosestSurface surface(s, is_meshed(s.kind) ? trees.triangles(s, world) : nullptr, settings.touch_merge_angle_rad);
    const Vector3d centre = s.pose * surface.centre();
    if (shape_) shape_->add(s, world);
    surfaces_.push_back({std::move(surface), traits[i], s.pose.inverse(), centre,
                         std::sqrt(traits[i].friction_static * tool_static_friction_),
                         std::sqrt(traits[i].friction_dynamic * tool_dynamic_friction_),
                         traits[i].compliance_1_Pa + own_compliance, 0});
    if (s.material < 0) continue;
    const material_def_t& m = world.materials[static_cast<std::size_t>(s.material)];
    surfaces_.back().bump_asset = m.bump_asset;
    if (m.bump_asset != 0) relief_m_ = std::max(relief_m_, m.bump_height_m);
    surfaces_.back().mapped = m.bump_asset != 0 || m.friction_asset != 0;
  }
  std::vector<SphereTree::Sphere> fixed;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const Surface& s = surfaces_[i];
    const BodyDef& body = world.bodies[static_cast<std::size_t>(s.traits.body)];
    // Between a shape and triangles all pairs within reach are checked: too many from afar.
    if (body.is_static) surfaces_[i].from_afar = !shape_ || (def.shape != tool_def_t::MESH && !is_meshed(s.traits.kind));
    if (body.is_static)
      fixed.push_back({body.pose * s.centre_in_body, s.shape.bound_m(), static_cast<int>(i)});
    else
      moving_.push_back({static_cast<int>(i), s.traits.body, s.shape.bound_m() + s.centre_in_body.norm()});
  }
  std::stable_sort(moving_.begin(), moving_.end(), [](const Moving& a, const Moving& b) { return a.body < b.body; });
  first_of_.assign(world.bodies.size() + 1, moving_.size());
  for (std::size_t i = moving_.size(); i-- > 0;) first_of_[static_cast<std::size_t>(moving_[i].body)] = i;
  for (std::size_t i = world.bodies.size(); i-- > 0;) first_of_[i] = std::min(first_of_[i], first_of_[i + 1]);
  fixed_ = SphereTree(std::move(fixed));
  model_.tool = points ? -1 : tool;
  model_.pages = 1;
  proxy_ = device_ = world.bodies[static_cast<std::size_t>(tool_body_)].pose.translation();
  if (shaped)
    proxy_orientation_ = device_orientation_ =
        Eigen::Quaterniond(world.bodies[static_cast<std::size_t>(tool_body_)].pose.linear()).normalized();
}

void ToolTouch::track(SimTime now, const SurfacePlane& plane, std::size_t surface, const Vector3d& tool_point_m) {
  Near* best = nullptr;
  double best_score = shape_ ? -1 : kSameSurface;
  for (Near& n : near_) {
    const double cosine = n.plane.normal.dot(plane.normal);
    if (n.surface != surface || n.last_seen == now || cosine <= kSameSurface) continue;
    // For a shaped tool, also compare the points on the tool; a nearer point scores higher.
    const double off = shape_ ? (n.tool_point_m - tool_point_m).norm() / kSameFeature_m : 0;
    if (off < 1 && cosine - off > best_score) best = &n, best_score = cosine - off;
  }
  if (best == nullptr) {
    best = &near_.emplace_back();
    best->contact_id = ids_.next_id();
    best->surface = surface;
  }
  best->plane = plane;
  best->tool_point_m = tool_point_m;
  best->last_seen = now;
  best->gap_m = plane.distance_m - radius_m_;
}

// For a shaped tool: tracks all places that may meet the surface.
void ToolTouch::track_shape(SimTime now, std::size_t surface, const BodyMotion& body, double reach_m) {
  const auto pose = [](const Vector3d& position, const Eigen::Quaterniond& orientation) {
    Eigen::Isometry3d p(orientation);
    p.translation() = position;
    return p;
  };
  shape_->query(surface, pose(body.position_m, body.orientation) * surfaces_[surface].traits.in_body,
                pose(proxy_, proxy_orientation_), reach_m, pairs_near_);
  for (const ToolPointPair& m : pairs_near_) track(now, m.plane, surface, m.tool_point_m);
}

void ToolTouch::find_surfaces(SimTime now, std::span<const BodyMotion> bodies) {
  const double reach = reach_m(), fixed_reach = fixed_reach_m(now);
  candidates_.clear();
  fixed_.near(proxy_, fixed_reach + kRounding_m, candidates_);
  const auto add_candidate = [&](const Moving& m) {
    // Check the position first, because there may be a thousand bodies.
    const BodyMotion& body = bodies[static_cast<std::size_t>(m.body)];
    const double about = m.bound_m + reach + kRounding_m;
    if ((proxy_ - body.position_m).squaredNorm() > about * about) return;
    const Surface& s = surfaces_[static_cast<std::size_t>(m.surface)];
    const double within = s.shape.bound_m() + reach;
    if ((proxy_ - body.to_world(s.centre_in_body)).squaredNorm() <= within * within) candidates_.push_back(m.surface);
  };
  if (!allowed_bodies_) std::for_each(moving_.begin(), moving_.end(), add_candidate);
  if (allowed_bodies_)
    for (const int body : *allowed_bodies_)
      for (std::size_t i = first_of_[static_cast<std::size_t>(body)]; i < first_of_[static_cast<std::size_t>(body) + 1]; ++i)
        add_candidate(moving_[i]);
  // In scene order, so that ids are issued in a fixed order.
  std::sort(candidates_.begin(), candidates_.end());
  for (const int candidate : candidates_) {
    const auto i = static_cast<std::size_t>(candidate);
    const Surface& s = surfaces_[i];
    const BodyMotion& body = bodies[static_cast<std::size_t>(s.traits.body)];
    const double within = s.from_afar ? fixed_reach : reach;
    if (shape_) {
      const double less_m = is_meshed(s.traits.kind) ? std::max(0.0, settings_.touch_margin_m - kMeshMargin_m) : 0;
      track_shape(now, i, body, within - bound_m_ - less_m);
      continue;
    }
    const Vector3d place = s.from_body * body.to_body(proxy_);
    s.shape.query(place, within, found_);
    // From afar only the nearest plane of a shape.
    if (found_.size() > 1)
      found_.erase(std::find_if(found_.begin() + 1, found_.end(), [&](const SurfacePlane& p) { return p.distance_m > reach; }),
                   found_.end());
    for (SurfacePlane plane : found_) {
      plane.point = body.to_world(s.traits.in_body * plane.point);
      plane.normal = body.orientation * (s.traits.in_body.linear() * plane.normal);
      track(now, plane, i, Vector3d::Zero());
    }
  }
  // A surface out of reach has a gap of at least this margin.
  for (Near& n : near_)
    if (n.last_seen != now) n.gap_m = std::max(n.gap_m, settings_.touch_margin_m);
  std::erase_if(near_, [&](const Near& n) { return !n.touching && now - n.last_seen > kTrackingTimeout; });
}

double ToolTouch::mobility_1_kg(const Near& n, std::span<const BodyMotion> bodies) const {
  const BodyMotion& body = body_of(n, bodies);
  if (!body.moves() || !mobility_) return mobility(body, n.plane.point, n.plane.normal);
  return mobility_(surfaces_[n.surface].traits.body, n.plane.point, n.plane.normal);
}

double ToolTouch::mass_kg(const Near& n, std::span<const BodyMotion> bodies) const {
  return 1 / (1 / tool_mass_kg_ + mobility_1_kg(n, bodies));
}

void ToolTouch::emit(const Near& n, std::int8_t kind, SimTime when, std::span<const BodyMotion> bodies,
                     std::vector<contact_event_t>& events) const {
  const SurfaceTraits& traits = surfaces_[n.surface].traits;
  contact_event_t e{};
  e.event_id = ids_.next_id();
  e.contact_id = n.contact_id;
  e.kind = kind;
  e.time_ns = std::max<std::int64_t>(0, sync::to_ns(when));
  const bool tool_is_b = traits.body < tool_body_;
  e.body_a = tool_is_b ? traits.body : tool_body_;
  e.body_b = tool_is_b ? tool_body_ : traits.body;
  e.material_a = tool_is_b ? traits.material : tool_material_;
  e.material_b = tool_is_b ? tool_material_ : traits.material;
  e.tool = tool_;
  e.point_m = to_vec3(n.plane.point);
  e.normal = to_vec3f(tool_is_b ? n.plane.normal : Vector3d(-n.plane.normal));
  e.approach_speed_m_s = static_cast<float>(std::max(0.0, n.closing_m_s));
  e.effective_mass_kg = static_cast<float>(mass_kg(n, bodies));
  const Vector3d in_body = body_of(n, bodies).to_body(n.plane.point);
  const double tool_curvature = radius_m_ > 0 ? 1 / radius_m_ : 1 / settings_.edge_radius_m;
  e.curvature_1_m = static_cast<float>(tool_curvature + curvature(traits, ContactKind::kPoint, in_body, -1));
  events.push_back(e);
}

// Updates the contact from one message to the next. The proxy never passes a surface, but the device does: the onset
// is the instant at which the gap of the device to the plane became zero.
void ToolTouch::update_contact(Near& n, SimTime when, SimTime before, SimTime now, std::span<const BodyMotion> bodies,
                      std::vector<contact_event_t>& events) {
  const Vector3d place = shape_ ? Vector3d(device_ + device_orientation_ * n.tool_point_m) : device_;
  const double gap = (place - n.plane.point).dot(n.plane.normal) - radius_m_;
  const Vector3d relative_velocity = velocity_of(n) - body_of(n, bodies).velocity_at(n.plane.point);
  const bool touches = n.force_N > kRounding_N || n.gap_m <= settings_.touch_gap_m;
  SimTime onset = when;
  if (n.has_device_gap && n.device_gap_m > 0 && gap <= 0)
    onset = before + sync::Nanoseconds(std::llround(static_cast<double>((when - before).count()) * n.device_gap_m /
                                                   (n.device_gap_m - gap)));
  onset = std::clamp(onset, now - kMaxMessageAge, now);
  if (touches && (!n.touching || n.apart)) {
    // Use the speed of the previous message, because the surface may already have stopped the device.
    n.closing_m_s = std::max(n.closing_m_s, -relative_velocity.dot(n.plane.normal));
    const bool is_new = !n.touching;
    n.touching = true;
    if (is_new) emit(n, contact_event_t::BEGIN, onset, bodies, events);
    const bool hit_allowed = !n.has_hit || onset - n.last_hit >= ns(settings_.hit_interval_s);
    if (n.closing_m_s >= settings_.hit_speed_m_s && hit_allowed) {
      emit(n, contact_event_t::HIT, onset, bodies, events);
      n.has_hit = true;
      n.last_hit = onset;
    }
    n.apart = false;
  } else if (n.touching && !n.apart && !touches && n.gap_m > settings_.touch_end_gap_m) {
    n.apart = true;
    n.separated_since = std::clamp(when, now - kMaxMessageAge, now);
  }
  n.closing_m_s = std::max(0.0, -relative_velocity.dot(n.plane.normal));
  n.device_gap_m = gap;
  n.has_device_gap = true;
}

void ToolTouch::receive(const tool_state_t& m, SimTime now, std::span<const BodyMotion> bodies,
                     std::vector<contact_event_t>& events) {
  const SimTime when = m.header.sim_time_ns >= 0 ? std::min(sync::sim_time(m.header.sim_time_ns), now) : now;
  const SimTime before = last_stamp_ < when && when - last_stamp_ < kMaxMessageAge ? last_stamp_ : when;
  last_stamp_ = when;
  has_message_ = true;
  last_message_ = now;
  device_ = to_eigen(m.device.position_m);
  velocity_ = to_eigen(m.device_velocity_m_s);
  if (shape_) {
    device_orientation_ = to_eigen(m.device.orientation).normalized();
    spin_ = to_eigen(m.device_spin_rad_s);
  }
  for (Near& n : near_) {
    n.force_N = 0;
    for (const tool_constraint_t& c : m.constraints) {
      if (c.contact_id != n.contact_id) continue;
      n.force_N = std::max(0.0, to_eigen(c.force_N).dot(n.plane.normal));
      n.impulse_N_s = std::max(n.impulse_N_s, to_eigen(c.impulse_N_s).dot(n.plane.normal));
    }
    update_contact(n, when, before, now, bodies, events);
  }
}

// The newest pose and velocity of the proxy, and whether it was found on a late model.
void ToolTouch::set_proxy(const tool_state_t& m, SimTime now) {
  if (m.touch_status >= static_cast<std::int8_t>(sync::SampleStatus::kHeld)) late_until_ = now + kLateFor;
  proxy_ = to_eigen(m.proxy.position_m);
  proxy_velocity_ = to_eigen(m.proxy_velocity_m_s);
  if (shape_) proxy_orientation_ = to_eigen(m.proxy.orientation).normalized();
}

void ToolTouch::update(SimTime now, std::span<const BodyMotion> bodies, std::span<const tool_state_t> new_messages,
                       std::vector<contact_event_t>& events) {
  if (!new_messages.empty()) set_proxy(new_messages.back(), now);
  find_surfaces(now, bodies);
  for (const tool_state_t& m : new_messages) receive(m, now, bodies, events);
  const bool lost = !has_message_ || now - last_message_ > ns(settings_.tool_stale_s);
  for (Near& n : near_) {
    if (!n.touching) continue;
    const bool over = n.apart && now - n.separated_since >= ns(settings_.contact_end_time_s);
    if (!over && !lost) continue;
    emit(n, contact_event_t::END, lost && !n.apart ? now : n.separated_since, bodies, events);
    n.touching = false;
    n.apart = true;
    n.impulse_N_s = n.force_N = 0;
    n.contact_id = ids_.next_id();  // the next touch is another contact
  }
  write_model(now, bodies);
}

void ToolTouch::write_model(SimTime now, std::span<const BodyMotion> bodies) {
  std::sort(near_.begin(), near_.end(), [](const Near& a, const Near& b) { return a.gap_m < b.gap_m; });
  model_.planes.clear();
  const double far_m = now < late_until_ ? reach_m() - bound_m_ : std::numeric_limits<double>::infinity();
  for (const Near& n : near_) {
    if (n.last_seen != now || model_.planes.size() >= static_cast<std::size_t>(settings_.touch_planes)) continue;
    if (n.gap_m > far_m && model_.planes.size() >= kMaxWithFar) continue;
    const Surface& s = surfaces_[n.surface];
    const BodyMotion& body = body_of(n, bodies);
    touch_plane_t& p = model_.planes.emplace_back();
    p.contact_id = n.contact_id;
    p.body = s.traits.body;
    p.material = s.traits.material;
    p.point_m = to_vec3(n.plane.point);
    p.normal = to_vec3f(n.plane.normal);
    p.point_body_m = to_vec3(body.to_body(n.plane.point));
    const Vector3d normal_body = body.orientation.conjugate() * n.plane.normal;
    p.normal_body = to_vec3f(normal_body);
    p.tool_point_m = to_vec3f(n.tool_point_m);
    p.velocity_m_s = to_vec3f(body.velocity_at(n.plane.point));
    p.angular_velocity_rad_s = to_vec3f(body.spin_rad_s);
    const double moved_1_kg = mobility_1_kg(n, bodies);
    p.effective_mass_kg = static_cast<float>(moved_1_kg > 0 ? std::min(1e9, 1 / moved_1_kg) : 1e9);
    p.stiffness_N_m = static_cast<float>(settings_.touch_stiffness_N_m);
    p.damping_N_s_m = static_cast<float>(settings_.touch_damping_Ns_m);
    p.friction_static = static_cast<float>(s.friction_static);
    p.friction_dynamic = static_cast<float>(s.friction_dynamic);
    p.bump_asset = s.bump_asset;
    if (s.mapped) p.bump_u = to_vec3f(body.orientation * Vector3d::Unit(bump_axes(normal_body).u));
  }
  model_.plane_count = static_cast<std::int8_t>(model_.planes.size());
}

void ToolTouch::describe(std::span<const BodyMotion> bodies, std::vector<contact_t>& out) const {
  for (const Near& n : near_) {
    if (!n.touching) continue;
    const SurfaceTraits& traits = surfaces_[n.surface].traits;
    const BodyMotion& body = body_of(n, bodies);
    const bool tool_is_b = traits.body < tool_body_;
    const Vector3d on_body = n.plane.point, on_tool = proxy_ + arm(n, proxy_orientation_);
    contact_t c{};
    c.contact_id = n.contact_id;
    c.kind = contact_t::POINT;
    c.body_a = tool_is_b ? traits.body : tool_body_;
    c.body_b = tool_is_b ? tool_body_ : traits.body;
    c.material_a = tool_is_b ? traits.material : tool_material_;
    c.material_b = tool_is_b ? tool_material_ : traits.material;
    c.tool = tool_;
    c.normal = to_vec3f(tool_is_b ? n.plane.normal : Vector3d(-n.plane.normal));
    c.depth_m = static_cast<float>(-n.gap_m);
    const double curved = (radius_m_ > 0 ? 1 / radius_m_ : 1 / settings_.edge_radius_m) +
                          curvature(traits, ContactKind::kPoint, body.to_body(n.plane.point), -1);
    c.area_m2 = static_cast<float>(hertz_point_area(n.force_N, curved, surfaces_[n.surface].compliance_1_Pa));
    c.normal_force_N = static_cast<float>(n.force_N);
    c.impulse_N_s = static_cast<float>(n.impulse_N_s);
    // Velocity of b's surface relative to a's. The tool's surface moves with its proxy, which has the velocity of the
    // device along the plane.
    const Vector3d relative_velocity = velocity_of(n) - body.velocity_at(n.plane.point);
    const Vector3d tangential = relative_velocity - relative_velocity.dot(n.plane.normal) * n.plane.normal;
    c.sliding_velocity_m_s = to_vec3f(tool_is_b ? tangential : Vector3d(-tangential));
    c.point_count = 1;
    const Vector3d in_tool = shape_ ? n.tool_point_m : Vector3d(on_tool - proxy_);
    contact_point_t p{};
    p.a_world_m = to_vec3(tool_is_b ? on_body : on_tool);
    p.b_world_m = to_vec3(tool_is_b ? on_tool : on_body);
    p.a_body_m = to_vec3(tool_is_b ? body.to_body(on_body) : in_tool);
    p.b_body_m = to_vec3(tool_is_b ? in_tool : body.to_body(on_body));
    c.points.push_back(p);
    out.push_back(c);
  }
}

}  // namespace tactus::sim
