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
constexpr double kMaxPixels = 64;
// Faster over a surface than an exploring hand (as in force_method.cpp): another point of the tool or surface is
// now the nearest, and no slope connects the two.
constexpr double kMaxHandSpeed_m_s = 5;

double towards(double from, double to, double max_change) {
  return from + std::clamp(to - from, -max_change, max_change);
}

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
  const Eigen::Vector2d motion =
      before.initialised ? Eigen::Vector2d(at - before.relief_uv) : Eigen::Vector2d::Zero();
  const double pixels = std::hypot(motion.x() * relief.columns, motion.y() * relief.rows);
  const int steps = pixels < kMaxPixels ? std::clamp(static_cast<int>(std::ceil(pixels)), 1, kMaxSteps) : 1;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int k = 0; k < steps; ++k) sum += relief.slope(at - motion * (static_cast<double>(k) / steps));
  sum /= steps;
  const double size = sum.norm();
  return size > def_.steepest ? Eigen::Vector2d(sum * (def_.steepest / size)) : sum;
}

Vector3d Reliefs::place_in_body(const Surface& s, const ToolPose& tool) {
  return s.mapped.point_body + s.mapped.rotation.transpose() * (tool.contact_point(s) - s.point);
}

void Reliefs::update_height(Surface& s, const Relief& relief, const ToolPose& tool, const Vector3d& place_body,
                            double dt) const {
  MappedPlace& m = s.mapped;
  const BumpAxes axes = bump_axes(m.normal_body);
  // Where the body turns so far that another projection of the map is nearest, the map jumps; the force is
  // blended.
  m.jumped = m.initialised && axes.across != m.axes.across;
  m.axes = axes;
  const bool by_height = height_share_ > 0;
  const double map_m = by_height ? relief.height_m(bump_at(relief.size_m, axes, place_body)) : 0;
  const double room_m = s.normal.dot(tool.position) - s.offset_m;  // between the proxy and the smooth surface
  const Vector3d motion = place_body - m.last_lookup_body;
  // along the surface; the height itself may move
  const double motion_m = (motion - motion.dot(m.normal_body) * m.normal_body).norm();
  m.last_lookup_body = place_body;
  if (m.height_relief != (by_height ? &relief : nullptr) || m.jumped || motion_m > kMaxHandSpeed_m_s * dt) {
    m.height_relief = by_height ? &relief : nullptr;
    m.map_height_m = map_m;
    const double height_m = height_share_ * map_m;
    // A new height yields as far as it would push the proxy; a height in use continues from its value.
    const double under_proxy_m = std::max(0.0, room_m) - height_m;
    m.height_lag_m = m.initialised ? m.height_m - height_m : std::min(0.0, under_proxy_m);
    if (s.depth_m <= 0) m.height_lag_m = std::min(m.height_lag_m, std::max(0.0, under_proxy_m));
    m.height_lag_speed_m_s = std::max(def_.recovery_speed_m_s, std::abs(m.height_lag_m) / def_.recovery_time_s);
  } else {
    double rise_m = map_m - m.map_height_m;
    const double max_change = std::max(def_.steepest * motion_m, def_.recovery_speed_m_s * dt);
    // Without pressure it may change freely while it stays under the proxy.
    rise_m = s.depth_m > 0 ? std::clamp(rise_m, -max_change, max_change)
                           : std::min(rise_m, std::max(max_change, room_m - m.map_height_m));
    m.map_height_m += rise_m;
  }
  m.height_lag_m = towards(m.height_lag_m, 0, m.height_lag_speed_m_s * dt);
  const double before_m = m.height_m;
  m.height_m = height_share_ * m.map_height_m + m.height_lag_m;
  // A new surface yields to the hand.
  m.height_change_m = m.initialised ? m.height_m - before_m : 0;
  s.offset_m += m.height_m;
}

void Reliefs::update_tilt(MappedPlace& m, const Relief& relief, const Vector3d& place_body, double decay) const {
  const Vector2d at = bump_at(relief.size_m, m.axes, place_body);
  if (m.jumped) m.initialised = false;
  Vector3d tilt = Vector3d::Zero();
  if (normal_share_ > 0)
    tilt = m.rotation * (relief_normal(m.normal_body, normal_share_ * slope(relief, m, at)) - m.normal_body);
  m.force_tilt_lag = decay * (m.jumped ? Vector3d(m.force_tilt - tilt) : m.force_tilt_lag);
  m.force_tilt = tilt + m.force_tilt_lag;
  m.relief_uv = at;
  m.initialised = true;
}

double Reliefs::half_energy_of_heights(std::span<const Surface> surfaces) {
  double sum_J = 0;
  for (const Surface& s : surfaces)
    if (!s.movable() && s.depth_m > 0) sum_J += 0.5 * s.coupling_stiffness_N_m * s.depth_m * s.mapped.height_change_m;
  return sum_J;
}

void Reliefs::apply_heights(std::span<Surface> surfaces, const ToolPose& tool, double dt) {
  const double max_change = dt / def_.recovery_time_s;
  height_share_ = towards(height_share_, def_.height ? 1 : 0, max_change);
  normal_share_ = towards(normal_share_, def_.normal ? 1 : 0, max_change);
  // One twentieth remains at the end of the recovery time.
  jump_decay_ = std::exp(-3 * dt / def_.recovery_time_s);
  for (Surface& s : surfaces) {
    s.mapped.height_change_m = 0;
    const MaterialMaps* maps = maps_ ? maps_->find(s.mapped.material) : nullptr;
    if (!maps) continue;
    const Vector3d at = place_in_body(s, tool);
    if (maps->friction) {
      const double factor = pair_factor(maps->friction->factor(s.mapped.normal_body, at));
      s.friction_static = factor * s.mapped.friction_static;
      s.friction_dynamic = factor * s.mapped.friction_dynamic;
    }
    if (maps->relief) update_height(s, *maps->relief, tool, at, dt);
  }
}

void Reliefs::tilt_forces(std::span<Surface> surfaces, const ToolPose& tool, std::span<Vector3d> forces_N) const {
  for (std::size_t i = 0; i < surfaces.size() && i < forces_N.size(); ++i) {
    Surface& s = surfaces[i];
    const MaterialMaps* maps = maps_ ? maps_->find(s.mapped.material) : nullptr;
    if (!maps || !maps->relief) {
      s.mapped.force_tilt.setZero();
      continue;
    }
    update_tilt(s.mapped, *maps->relief, place_in_body(s, tool), jump_decay_);
    if (s.mapped.force_tilt.isZero(0)) continue;
    const double pressed_N = forces_N[i].dot(s.normal);
    forces_N[i] += pressed_N * ((s.normal + s.mapped.force_tilt).normalized() - s.normal);
  }
}

Vector3d without_tilt(const Surface& s, const Vector3d& force_N) {
  if (s.mapped.force_tilt.isZero(0)) return force_N;
  const Vector3d tilted = (s.normal + s.mapped.force_tilt).normalized();
  const double along = tilted.dot(s.normal);
  constexpr double kSteep = 1e-3;  // a force almost along the surface has no part that presses
  return along > kSteep ? Vector3d(force_N - force_N.dot(s.normal) / along * (tilted - s.normal)) : force_N;
}

}  // namespace tactus::haptic
