#include "haptic_node/reliefs.h"

#include <algorithm>
#include <cmath>

namespace tactus::haptic {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// A tick of a fast hand leaps over pixels: the force is the mean of what lies between, at so many places at most.
// Design: at 0.5 m/s and 1 kHz those of a map with 16 pixels a millimetre.
constexpr int kMostSteps = 8;
// In pixels; a hand that went so far in a tick was put there.
constexpr double kLeap = 64;

// Where a place of the body frame lies in a relief.
Vector2d repetitions(const Relief& relief, const BumpAxes& axes, const Vector3d& place_body) {
  return {place_body[axes.u] / static_cast<double>(relief.size_m.x()),
          place_body[axes.v] / static_cast<double>(relief.size_m.y())};
}

double towards(double from, double to, double most) { return from + std::clamp(to - from, -most, most); }

}  // namespace

ReliefDef relief_def(const std::string& bump, double steepest, double recovery_time_s) {
  const bool both = bump == "both";
  return {both || bump == "height", both || bump == "normal", steepest, recovery_time_s};
}

void Reliefs::set_maps(std::shared_ptr<const SurfaceMaps> maps) {
  maps_ = std::move(maps);
  height_share_ = normal_share_ = 0;
}

// From the place of the last tick, which is not counted, to this one.
Eigen::Vector2d Reliefs::slope(const Relief& relief, const MappedPlace& before, const Eigen::Vector2d& at) const {
  const Eigen::Vector2d way = before.known ? Eigen::Vector2d(at - before.at) : Eigen::Vector2d::Zero();
  const double pixels = std::hypot(way.x() * relief.columns, way.y() * relief.rows);
  const int steps = pixels < kLeap ? std::clamp(static_cast<int>(std::ceil(pixels)), 1, kMostSteps) : 1;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int k = 0; k < steps; ++k) sum += relief.slope(at - way * (static_cast<double>(k) / steps));
  sum /= steps;
  const double size = sum.norm();
  return size > def_.steepest ? Eigen::Vector2d(sum * (def_.steepest / size)) : sum;
}

Vector3d Reliefs::place(const Surface& s, const ToolPlace& tool) {
  return s.mapped.point_body + s.mapped.turn.transpose() * (tool.touched(s) - s.point);
}

void Reliefs::raise(Surface& s, const Relief& relief, const Vector3d& place_body, double kept) const {
  MappedPlace& m = s.mapped;
  const BumpAxes axes = bump_axes(m.normal_body);
  // Where the body turns so far that another projection of the map is nearest, the map jumps; the hand is led
  // over.
  m.jumped = m.known && axes.across != m.axes.across;
  m.axes = axes;
  const double height_m =
      height_share_ > 0 ? height_share_ * relief.height_m(repetitions(relief, axes, place_body)) : 0;
  m.height_lag_m = kept * (m.jumped ? m.height_m - height_m : m.height_lag_m);
  m.height_m = height_m + m.height_lag_m;
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
  // A twentieth is left when the recovery time is over.
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
    if (maps->relief) raise(s, *maps->relief, at, kept_);
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
