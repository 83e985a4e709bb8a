#include "haptic_node/reliefs.h"

#include <algorithm>
#include <cmath>

namespace tactus::haptic {
namespace {

// A tick of a fast hand leaps over pixels: the force is the mean of what lies between, at so many places at most.
// Design: at 0.5 m/s and 1 kHz those of a map with 16 pixels a millimetre.
constexpr int kMostSteps = 8;
// In pixels; a hand that went so far in a tick was put there.
constexpr double kLeap = 64;

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

void Reliefs::look(Surface& s, const Relief& relief, const Eigen::Vector3d& place_body, double dt) const {
  MappedPlace& m = s.mapped;
  const BumpAxes axes = bump_axes(m.normal_body);
  const Eigen::Vector2d at(place_body[axes.u] / static_cast<double>(relief.size_m.x()),
                           place_body[axes.v] / static_cast<double>(relief.size_m.y()));
  // Where the body turns so far that another projection of the map is nearest, it jumps; the hand is led over.
  const bool jumped = m.known && axes.across != m.axes.across;
  if (jumped) m.known = false;
  const double height_m = height_share_ > 0 ? height_share_ * relief.height_m(at) : 0;
  Eigen::Vector3d lean = Eigen::Vector3d::Zero();
  if (normal_share_ > 0)
    lean = m.turn * (relief_normal(m.normal_body, normal_share_ * slope(relief, m, at)) - m.normal_body);
  if (jumped) {
    m.height_lag_m = m.height_m - height_m;
    m.lean_lag = m.lean - lean;
  }
  // The rest is a twentieth when the recovery time is over.
  const double kept = std::exp(-3 * dt / def_.recovery_time_s);
  m.height_lag_m *= kept;
  m.lean_lag *= kept;
  m.height_m = height_m + m.height_lag_m;
  m.lean = lean + m.lean_lag;
  m.axes = axes;
  m.at = at;
  m.known = true;
  s.offset_m += m.height_m;
}

void Reliefs::look(std::span<Surface> surfaces, const Eigen::Vector3d& proxy, double tool_radius_m, double dt) {
  const double most = dt / def_.recovery_time_s;
  height_share_ = towards(height_share_, def_.height ? 1 : 0, most);
  normal_share_ = towards(normal_share_, def_.normal ? 1 : 0, most);
  for (Surface& s : surfaces) {
    const MaterialMaps* maps = maps_ ? maps_->of(s.mapped.material) : nullptr;
    if (!maps) {
      s.mapped.lean.setZero();
      continue;
    }
    const Eigen::Vector3d touched = proxy - tool_radius_m * s.normal;
    const Eigen::Vector3d place = s.mapped.point_body + s.mapped.turn.transpose() * (touched - s.point);
    if (maps->friction) {
      const double factor = pair_factor(maps->friction->factor(s.mapped.normal_body, place));
      s.friction_static = factor * s.mapped.friction_static;
      s.friction_dynamic = factor * s.mapped.friction_dynamic;
    }
    if (maps->relief) look(s, *maps->relief, place, dt);
  }
}

void Reliefs::lean(std::span<const Surface> surfaces, std::span<Eigen::Vector3d> forces_N) const {
  for (std::size_t i = 0; i < surfaces.size() && i < forces_N.size(); ++i) {
    const Surface& s = surfaces[i];
    if (s.mapped.lean.isZero(0)) continue;
    const double pressed_N = forces_N[i].dot(s.normal);
    forces_N[i] += pressed_N * ((s.normal + s.mapped.lean).normalized() - s.normal);
  }
}

}  // namespace tactus::haptic
