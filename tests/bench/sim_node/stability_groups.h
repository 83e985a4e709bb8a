// How stiff contact may be in a world of one group and in one of two (Kim, Sung, Park 2005), with the whole
// simulation: near a hand and far from it, and of the hand itself.
#pragma once

#include <span>
#include <string>

namespace tactus::sim::bench {

struct GroupedRow {
  std::string name, groups, solver;  // as the settings
  double step_s;                     // of the bodies near the hand
};

// The rows of the table.
std::span<const GroupedRow> grouped_rows();

// Whether contact at x = k h^2 / m, m the mass on a point of it, lets a ball, or a tower of so many boxes, stand
// within reach of a hand, and the same out of its reach: pushed at random by 1 um/s, what moves dies away, or at
// least does not grow. False too where the simulation refuses it. Throws std::logic_error when the groups are not
// as meant.
bool grouped_stays_stable(const GroupedRow& row, int boxes, double x);

// Whether two hands of that stiffness each, damped by a ratio of 0.7, hold a box between them: pushed, it comes to
// rest and does not swing ever further. Hands feel and act every millisecond, the world hears them with its next
// step.
bool hands_hold(const GroupedRow& row, double stiffness_N_m);

inline constexpr double kHeld_kg = 0.2;  // the box

}  // namespace tactus::sim::bench
