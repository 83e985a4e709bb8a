// The point of a convex region that is closest to a goal: the quadratic programme behind the god-object (Zilles
// and Salisbury 1995, section 4; Ruspini, Kolarov and Khatib 1997): minimise |x - goal|^2 so that normal_i . x >=
// offset_i.
//
// In three dimensions at most three half spaces bind (the problem is of LP type: Sharir and Welzl 1992). So the one
// that is violated most is exchanged against those that bind, where all sets of up to three that hold it are tried
// until one satisfies the Karush-Kuhn-Tucker conditions. Each exchange takes the point farther from the goal, so none
// comes back: exact, linear in the half spaces per exchange, a few exchanges, and no state from tick to tick.
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
  // point = goal + sum of multiplier_i normal_i, all >= 0: how deep the goal lies under each binding half space,
  // m.
  std::array<double, kMaxHalfSpaces> multiplier{};
  // False: the half spaces have no point in common. Then the squares of the violations of `point` are least
  // (nearly), and a multiplier is how far the goal itself lies under that half space.
  bool feasible = true;
};

// At most kMaxHalfSpaces; more are ignored. Realtime-safe: yes.
ClosestPoint closest_point(std::span<const HalfSpace> region, const Eigen::Vector3d& goal);

}  // namespace tactus::haptic
