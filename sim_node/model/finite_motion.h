// A state that is not finite stops the world: no force, pose or sound may follow from it.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

#include "sim_node/model/body_motion.h"

namespace tactus::sim {

// A sum of finite numbers below 1e300 is finite, and a number that is not finite stays so in a sum. Realtime-safe: yes.
inline double sum_of_state(const BodyMotion& m) {
  const Eigen::Vector3d sum = m.position_m + m.centre_m + m.velocity_m_s + m.spin_rad_s;
  const Eigen::Quaterniond& q = m.orientation;
  return sum.x() + sum.y() + sum.z() + q.x() + q.y() + q.z() + q.w();
}

// The first quantity of a body that is not finite, as the subject of a sentence; null: all are finite. Realtime-safe: yes.
inline const char* infinite_quantity(const BodyMotion& m) {
  if (std::isfinite(sum_of_state(m))) return nullptr;
  if (!m.position_m.allFinite() || !m.centre_m.allFinite()) return "the position";
  if (!m.orientation.coeffs().allFinite()) return "the orientation";
  if (!m.velocity_m_s.allFinite()) return "the velocity";
  return m.spin_rad_s.allFinite() ? nullptr : "the spin";
}

// Simulation adds the name of the body and the step to the sentence.
class StateNotFinite : public std::runtime_error {
 public:
  StateNotFinite(int body_index, const char* of)
      : std::runtime_error(std::string(of) + " of the body with the index " + std::to_string(body_index) + " is not finite, so the world stops"),
        body(body_index),
        quantity(of) {}
  int body;  // index in the world
  const char* quantity;
};

// Throws StateNotFinite.
inline void require_finite(int body, const BodyMotion& motion) {
  if (const char* const quantity = infinite_quantity(motion)) throw StateNotFinite(body, quantity);
}

}  // namespace tactus::sim
