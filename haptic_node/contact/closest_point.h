// The point of a convex region that is closest to a goal: the quadratic programme of the god-object (Zilles and
// Salisbury 1995, section 4; Ruspini, Kolarov and Khatib 1997): minimise |x - goal|^2 so that normal_i . x >=
// offset_i.
//
// In three dimensions at most three half spaces bind (the problem is of LP type: Sharir and Welzl 1992). Each
// exchange takes the most violated half space and tries all sets of up to three that contain it, until one
// satisfies the Karush-Kuhn-Tucker conditions. Each exchange increases the distance from the goal, so no set
// repeats. The method is exact, linear in the number of half spaces per exchange, takes a few exchanges, and keeps
// no state between ticks.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

namespace tactus::haptic {

struct HalfSpace {
  Eigen::Vector3d normal;  // unit, into the allowed side
  double offset = 0;       // m, along the normal from the origin
};

inline constexpr std::size_t kMaxHalfSpaces = 64;

struct ClosestPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  // point = goal + sum of multiplier_i normal_i, all >= 0: depth of the goal under each binding half space, m.
  std::array<double, kMaxHalfSpaces> multiplier{};
  // False: the half spaces have no common point. Then `point` approximately minimises the sum of squared
  // violations, and a multiplier is the depth of the goal under that half space.
  bool feasible = true;
};

// At most kMaxHalfSpaces; more are ignored. Realtime-safe: yes.
ClosestPoint closest_point(std::span<const HalfSpace> region, const Eigen::Vector3d& goal);

}  // namespace tactus::haptic
