#include "haptic_node/contact/reliefs.h"

#include <algorithm>
#include <cmath>

namespace tactus::haptic {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// In one tick a fast hand crosses several pixels: the slope is the mean over at most this number of places.
// Design: at 0.5 m/s and 1 kHz this covers a map with 16 pixels per millimetre.
constexpr int kMaxSteps = 8;
// In pixels; a hand that moved further in one tick was repositioned.
constexpr double kLeap = 64;
// Faster over a surface than an exploring hand (as in rendering.cpp): another point of the tool or surface is now
// the nearest, and no slope connects the two.
constexpr double kFastestHand_m_s = 5;

// Position in a relief of a place in the body frame.
Vector2d repetitions(const Relief& relief, const BumpAxes& axes, const Vector3d& place_body) {
  return {place_body[axes.u] / static_cast<double>(relief.size_m.x()),
          place_body[axes.v] / static_cast<double>(relief.size_m.y())};
}

double towards(double from, double to, double most) { return from + std::clamp(to - from, -most, most); }

}  // namespace

ReliefDef relief_def(const std::string& bump, double steepest, double recovery_time_s, double recovery_speed_m_s) {
  const bool both = bump == "both";
  return {both || bump == "height", both || bump == "normal", steepest, recovery_time_s, recovery_speed_m_s};
}

void Reliefs::set_maps(std::shared_ptr<const SurfaceMaps> maps) {
  maps_ = std::move(maps);
  height_share_ = normal_share_ = 0;
}

// Mean over the path from the place of the last tick, excluded, to this one.
Eigen::Vector2d Reliefs::slope(const Relief& relief, const MappedPlace& before, const Eigen::Vector2d& at) const {
  const Eigen::Vector2d way = before.known ? Eigen::Vector2d(at - before.at) : Eigen::Vector2d::Zero();
  const double pixels = std::hypot(way.x() * relief.columns, way.y() * relief.rows);
  const int steps = pixels < kLeap ? std::clamp(static_cast<int>(std::ceil(pixels)), 1, kMaxSteps) : 1;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int k = 0; k < steps; ++k) sum += relief.slope(at - way * (static_cast<double>(k) / steps));
  sum /= steps;
  const double size = sum.norm();
  return size > def_.steepest ? Eigen::Vector2d(sum * (def_.steepest / size)) : sum;
}

Vector3d Reliefs::place(const Surface& s, const ToolPlace& tool) {
  return s.mapped.point_body + s.mapped.turn.transpose() * (tool.touched(s) - s.point);
}

void Reliefs::raise(Surface& s, const Relief& relief, const ToolPlace& tool, const Vector3d& place_body,
                    double dt) const {
  MappedPlace& m = s.mapped;
  const BumpAxes axes = bump_axes(m.normal_body);
  // Where the body turns so far that another projection of the map is nearest, the map jumps; the force is
  // blended.
  m.jumped = m.known && axes.across != m.axes.across;
  m.axes = axes;
  const bool by_height = height_share_ > 0;
  const double map_m = by_height ? relief.height_m(repetitions(relief, axes, place_body)) : 0;
  const double room_m = s.normal.dot(tool.position) - s.offset_m;  // between the proxy and the smooth surface
  const Vector3d way = place_body - m.looked_at_body;
  // along the surface; the height itself may move
  const double way_m = (way - way.dot(m.normal_body) * m.normal_body).norm();
  m.looked_at_body = place_body;
  if (m.raised_by != (by_height ? &relief : nullptr) || m.jumped || way_m > kFastestHand_m_s * dt) {
    m.raised_by = by_height ? &relief : nullptr;
    m.map_height_m = map_m;
    const double height_m = height_share_ * map_m;
    // A new height yields as far as it would push the proxy; a height in use continues from its value.
    const double under_proxy_m = std::max(0.0, room_m) - height_m;
    m.height_lag_m = m.known ? m.height_m - height_m : std::min(0.0, under_proxy_m);
    if (s.depth_m <= 0) m.height_lag_m = std::min(m.height_lag_m, std::max(0.0, under_proxy_m));
    m.height_lag_speed_m_s = std::max(def_.recovery_speed_m_s, std::abs(m.height_lag_m) / def_.recovery_time_s);
  } else {
    double rise_m = map_m - m.map_height_m;
    const double most = std::max(def_.steepest * way_m, def_.recovery_speed_m_s * dt);
    // Without pressure it may change freely while it stays under the proxy.
    rise_m = s.depth_m > 0 ? std::clamp(rise_m, -most, most)
                           : std::min(rise_m, std::max(most, room_m - m.map_height_m));
    m.map_height_m += rise_m;
  }
  m.height_lag_m = towards(m.height_lag_m, 0, m.height_lag_speed_m_s * dt);
  m.height_m = height_share_ * m.map_height_m + m.height_lag_m;
  s.offset_m += m.height_m;
}

void Reliefs::tilt(MappedPlace& m, const Relief& relief, const Vector3d& place_body, double kept) const {
  const Vector2d at = repetitions(relief, m.axes, place_body);
  if (m.jumped) m.known = false;
  Vector3d lean = Vector3d::Zero();
  if (normal_share_ > 0)
    lean = m.turn * (relief_normal(m.normal_body, normal_share_ * slope(relief, m, at)) - m.normal_body);
  m.lean_lag = kept * (m.jumped ? Vector3d(m.lean - lean) : m.lean_lag);
  m.lean = lean + m.lean_lag;
  m.at = at;
  m.known = true;
}

void Reliefs::look(std::span<Surface> surfaces, const ToolPlace& tool, double dt) {
  const double most = dt / def_.recovery_time_s;
  height_share_ = towards(height_share_, def_.height ? 1 : 0, most);
  normal_share_ = towards(normal_share_, def_.normal ? 1 : 0, most);
  // One twentieth remains at the end of the recovery time.
  kept_ = std::exp(-3 * dt / def_.recovery_time_s);
  for (Surface& s : surfaces) {
    const MaterialMaps* maps = maps_ ? maps_->of(s.mapped.material) : nullptr;
    if (!maps) continue;
    const Vector3d at = place(s, tool);
    if (maps->friction) {
      const double factor = pair_factor(maps->friction->factor(s.mapped.normal_body, at));
      s.friction_static = factor * s.mapped.friction_static;
      s.friction_dynamic = factor * s.mapped.friction_dynamic;
    }
    if (maps->relief) raise(s, *maps->relief, tool, at, dt);
  }
}

void Reliefs::lean(std::span<Surface> surfaces, const ToolPlace& tool, std::span<Vector3d> forces_N) const {
  for (std::size_t i = 0; i < surfaces.size() && i < forces_N.size(); ++i) {
    Surface& s = surfaces[i];
    const MaterialMaps* maps = maps_ ? maps_->of(s.mapped.material) : nullptr;
    if (!maps || !maps->relief) continue;
    tilt(s.mapped, *maps->relief, place(s, tool), kept_);
    if (s.mapped.lean.isZero(0)) continue;
    const double pressed_N = forces_N[i].dot(s.normal);
    forces_N[i] += pressed_N * ((s.normal + s.mapped.lean).normalized() - s.normal);
  }
}

}  // namespace tactus::haptic
