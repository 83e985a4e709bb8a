// Where the grip is, from how long its strings are: least squares over all strings, by Levenberg's and Marquardt's
// steps from where it was last.
#pragma once

#include "haptic_node/devices/spidar/string_frame.h"

namespace tactus::haptic {

struct SolvedPose {
  GripPose pose;
  double residual_m = 0;  // root mean square over the strings
  int steps = 0;
  bool converged = false;  // no step of a thousandth of a count is left
};

// lengths_m: frame.size() of them. from: where the grip was. Realtime-safe: yes; at most 30 steps, one or two at 1
// kHz.
SolvedPose solve_pose(const StringFrame& frame, const PerString& lengths_m, const GripPose& from);

}  // namespace tactus::haptic
