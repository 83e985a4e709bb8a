// Work of a wrench on the hand over a motion of the device, and the motion that a force may add to it. Pure.
#pragma once

#include "haptic_node/devices/device.h"

namespace tactus::haptic {

// Motion of the device that a tick reports, and its timing.
struct DeviceMotion {
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero(), turned_rad = Eigen::Vector3d::Zero();
  DeviceLoop loop{};
};

// Work on the hand, J; 0 for a motion that no hand makes within span_s.
double work_J(const Wrench& wrench, const DeviceMotion& motion, double span_s);

// Twice the distance, m/N, that a constant force moves a mass with a damper from rest: twice, because its speed at the
// begin may be higher than the mean of the last motion by as much. The same for an inertia, rad/(N m).
double twice_moved(double seconds, double mass_kg, double damping_N_s_m);

}  // namespace tactus::haptic
