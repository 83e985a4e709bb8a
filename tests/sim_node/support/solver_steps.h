// Steps and results of a solver.
#pragma once

#include <cmath>

#include "sim_node/behaviour/solver.h"
#include "tests/sim_node/support/small_worlds.h"

namespace tactus::sim::test {

inline const BodyMotion& body(const Solver& s, int i) { return s.bodies()[static_cast<std::size_t>(i)]; }

inline void run(Solver& s, double seconds) {
  for (int i = 0; i < std::lround(seconds / kStep); ++i) s.step();
}

// The part of a rotation that is about this axis, rad, -2 pi .. 2 pi.
inline double angle_about(const Eigen::Quaterniond& q, const Eigen::Vector3d& axis) {
  return 2 * std::atan2(q.vec().dot(axis), q.w());
}

}  // namespace tactus::sim::test
