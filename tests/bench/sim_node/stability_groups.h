// Stability limits of contact stiffness in a world of one group and in one of two (Kim, Sung, Park 2005), with the whole simulation: near
// a hand, far from it, and of the hand itself.
#pragma once

#include <span>
#include <string>

namespace tactus::sim::bench {

struct GroupedRow {
  std::string name, groups, solver;  // as the settings
  double step_s;                     // step for the bodies near the hand
};

// The rows of the table.
std::span<const GroupedRow> grouped_rows();

// Whether contact at x = k h^2 / m, m the mass on a point of it, lets a ball, or a tower of `boxes` boxes, stand within reach of a hand,
// and the same out of its reach: after a random push of 1 um/s the motion decays, or at least does not grow. False too where the
// simulation refuses it. Throws std::logic_error when the groups are not as intended.
bool grouped_stays_stable(const GroupedRow& row, int boxes, double x);

// Whether two hands of that stiffness each, damped by a ratio of 0.7, hold a box between them: after a push it comes to rest and its
// oscillation does not grow. Hands sense and act every millisecond; the world receives their forces with its next step.
bool two_hands_stay_stable(const GroupedRow& row, double stiffness_N_m);

inline constexpr double kHeld_kg = 0.2;  // the box

}  // namespace tactus::sim::bench
