// String tensions for a wanted force. Strings pull and cannot push, go slack below a minimum tension, and their
// motors have a maximum. Of all tensions that give the force, the smallest are used. Where none exist, the force
// keeps its direction and is reduced, by at most one fiftieth more than necessary.
#pragma once

#include "haptic_node/devices/device.h"
#include "haptic_node/devices/spidar/string_frame.h"

namespace tactus::haptic {

struct Tensions {
  PerString tensions_N;      // always within the limits of the frame
  Wrench realised;           // result of the tensions at rest
  double share = 0;          // realised share of the wanted wrench, 0 .. 1; 1: all of it
  double force_error_N = 0;  // |realised - wanted|
  double torque_error_N_m = 0;
  // False: the pose is singular, or no tensions within the limits hold the grip at rest. All tensions are then the
  // minimum, and `realised` is the resulting wrench.
  bool held = false;
};

// wanted: on the hand, about the origin of the grip; with four strings its torque is ignored. Exact except for
// rounding. Continuous in wrench and pose while `held`. Realtime-safe: yes.
Tensions solve_tensions(const StringFrame& frame, const GripPose& pose, const Wrench& wanted);

}  // namespace tactus::haptic
