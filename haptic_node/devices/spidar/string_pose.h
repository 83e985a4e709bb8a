// Pose of the grip from the lengths of its strings: least squares over all strings, by the method of Levenberg and
// Marquardt from the last pose.
#pragma once

#include "haptic_node/devices/spidar/string_frame.h"

namespace tactus::haptic {

struct SolvedPose {
  GripPose pose;
  double residual_m = 0;  // root mean square over the strings
  int steps = 0;
  bool converged = false;  // the remaining step is below a thousandth of a count
};

// lengths_m: frame.size() values. from: previous pose of the grip. Realtime-safe: yes; at most 30 steps, one or
// two at 1 kHz.
SolvedPose solve_pose(const StringFrame& frame, const PerString& lengths_m, const GripPose& from);

}  // namespace tactus::haptic
