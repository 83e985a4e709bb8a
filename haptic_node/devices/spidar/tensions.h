// Which tensions give a wanted force: strings pull and cannot push, hang through below a least tension, and their
// motors end at a largest. Of all tensions that give the force the smallest are taken; where none do, the force
// keeps its direction and loses size, at most a fiftieth more than it must.
#pragma once

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/spidar/string_frame.h"

namespace tactus::haptic {

struct Tensions {
  PerString tensions_N;      // within the frame's limits, always
  Wrench realised;           // what they give while nothing moves
  double share = 0;          // realised of the wanted wrench, 0 .. 1; 1: all of it
  double force_error_N = 0;  // |realised - wanted|
  double torque_error_N_m = 0;
  // False: the pose is singular, or no tensions within the limits even keep the grip at rest. All are then the
  // least, and the wrench is what comes of that.
  bool held = false;
};

// wanted: on the hand, about the grip's origin; its torque is left out with four strings. Exact but for rounding.
// Continuous in wrench and pose as long as `held`. Realtime-safe: yes.
Tensions solve_tensions(const StringFrame& frame, const GripPose& pose, const Wrench& wanted);

}  // namespace tactus::haptic
