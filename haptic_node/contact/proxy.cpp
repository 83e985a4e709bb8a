#include "haptic_node/contact/proxy.h"

#include <algorithm>

namespace tactus::haptic {
namespace {

// Longer than any arm: a valid scene never displaces the coupling that far.
constexpr double kMaxStretch_m = 2;

// v without its component along the total normal force of all surfaces. It does not remove the component along
// every binding normal: when two facets meet in a shallow groove, that would suddenly remove the friction across
// it in the tick in which the second facet joins, although its share of the force begins at zero.
Eigen::Vector3d tangential(const Eigen::Vector3d& v, std::span<const Surface> surfaces) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const Surface& s : surfaces) normal += s.depth_m * s.normal;
  const double square = normal.squaredNorm();
  return square > 0 ? Eigen::Vector3d(v - normal * (v.dot(normal) / square)) : v;
}

// Widest shift that the cones of the binding surfaces allow, m.
double cone_width(std::span<const Surface> surfaces, bool slipping) {
  double width = 0;
  for (const Surface& s : surfaces) width += s.depth_m * (slipping ? s.friction_dynamic : s.friction_static);
  return width;
}

ClosestPoint solve(std::span<Surface> surfaces, const Eigen::Vector3d& goal) {
  std::array<HalfSpace, kMaxHalfSpaces> region;
  const std::size_t n = std::min(surfaces.size(), kMaxHalfSpaces);
  for (std::size_t i = 0; i < n; ++i) region[i] = {surfaces[i].normal, surfaces[i].offset_m};
  const ClosestPoint closest = closest_point({region.data(), n}, goal);
  for (std::size_t i = 0; i < n; ++i) surfaces[i].depth_m = closest.multiplier[i];
  return closest;
}

}  // namespace

// Position of the proxy after one tick if it moves with the surfaces, weighted by depth.
Eigen::Vector3d Proxy::carried(std::span<const Surface> surfaces, double dt) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weight = 0;
  for (const Surface& s : surfaces) {
    sum += s.depth_m * s.velocity_at(position_);
    weight += s.depth_m;
  }
  return weight > 0 ? Eigen::Vector3d(position_ + sum * (dt / weight)) : position_;
}

void Proxy::step(std::span<Surface> surfaces, const Eigen::Vector3d& device, double dt) {
  const Eigen::Vector3d pull = carried(surfaces, dt) - device;
  Eigen::Vector3d shift = touching_ ? tangential(pull, surfaces) : Eigen::Vector3d::Zero();
  ClosestPoint closest = solve(surfaces, device + shift);
  // The normal force and the width of the cone depend on the shift and the shift on them: a few iterations
  // converge.
  constexpr int kRounds = 4, kNarrowings = 8;
  constexpr double kSettled_m = 1e-9;
  bool slips = slipping_;
  for (int round = 0; round < kRounds && shift.norm() > 0; ++round) {
    const Eigen::Vector3d wanted = tangential(pull, surfaces);
    const double width = cone_width(surfaces, slipping_);
    slips = wanted.norm() > width;
    const double allowed = slips ? cone_width(surfaces, true) : wanted.norm();
    const Eigen::Vector3d next = slips ? Eigen::Vector3d(wanted * (allowed / wanted.norm())) : wanted;
    const bool settled = (next - shift).norm() < kSettled_m;
    if (settled) break;
    shift = next;
    closest = solve(surfaces, device + shift);
  }
  // Without convergence the shift may be wider than the resulting cone; a zero shift never is.
  for (int k = 0; k <= kNarrowings && shift.norm() > cone_width(surfaces, slipping_) + kSettled_m; ++k) {
    slips = true;
    shift *= k < kNarrowings ? cone_width(surfaces, true) / shift.norm() : 0.0;
    closest = solve(surfaces, device + shift);
  }
  slipping_ = slips && shift.norm() > 0;
  if (!closest.feasible) {
    shift.setZero();
    closest = solve(surfaces, device);
  }
  feasible_ = closest.feasible;
  touching_ = std::any_of(surfaces.begin(), surfaces.end(), [](const Surface& s) { return s.depth_m > 0; });
  if (!touching_) slipping_ = false;
  // Invalid input, for example two nearly parallel planes far away, must not move the tool out of the world.
  const Eigen::Vector3d stretch = closest.point - device;
  if (stretch.norm() > kMaxStretch_m) closest.point = device + stretch * (kMaxStretch_m / stretch.norm());
  velocity_ = dt > 0 ? Eigen::Vector3d((closest.point - position_) / dt) : Eigen::Vector3d::Zero();
  position_ = closest.point;
  shift_ = shift;
}

}  // namespace tactus::haptic
