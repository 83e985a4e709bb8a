#include "haptic_node/safety/motion_work.h"

#include <cmath>

#include "haptic_node/safety/hand_limits.h"

namespace tactus::haptic {

double work_J(const Wrench& wrench, const DeviceMotion& motion, double span_s) {
  const bool moved = motion.moved_m.allFinite() && motion.moved_m.norm() <= kMaxHandSpeed_m_s * span_s;
  const bool turned = motion.turned_rad.allFinite() && motion.turned_rad.norm() <= kMaxHandSpin_rad_s * span_s;
  return (moved ? wrench.force_N.dot(motion.moved_m) : 0) + (turned ? wrench.torque_N_m.dot(motion.turned_rad) : 0);
}

double twice_moved(double seconds, double mass_kg, double damping_N_s_m) {
  const double x = seconds * damping_N_s_m / mass_kg;
  // (x - 1 + exp(-x)) / x^2, by its series where the difference would cancel.
  const double share = x < 1e-3 ? 0.5 - x / 6 : (x + std::expm1(-x)) / (x * x);
  return 2 * share * seconds * seconds / mass_kg;
}

}  // namespace tactus::haptic
