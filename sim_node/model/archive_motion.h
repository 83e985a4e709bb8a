// Archive functions shared by several states.
#pragma once

#include <cmath>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/manifold.h"
#include "sim_node/model/state_archive.h"

namespace tactus::sim {

// Bounds of a motion that can be continued without an overflow, far beyond any scene: a body that falls for a week stays within
// them.
inline constexpr double kMaxPosition_m = 1e13, kMaxRate = 1e9;  // rate: m/s or rad/s
inline constexpr double kMaxMobility = 1e12;                    // 1/kg or 1/(kg m^2)
inline constexpr const char* kImplausible = "the state holds a motion that no body can have";

inline bool plausible(const Eigen::Vector3d& position_m, const Eigen::Vector3d& velocity_m_s, const Eigen::Vector3d& spin_rad_s) {
  return position_m.cwiseAbs().maxCoeff() <= kMaxPosition_m && velocity_m_s.cwiseAbs().maxCoeff() <= kMaxRate &&
         spin_rad_s.cwiseAbs().maxCoeff() <= kMaxRate;
}

inline bool plausible(const BodyMotion& m) {
  constexpr double kMaxNormError = 1e-3;
  return plausible(m.position_m, m.velocity_m_s, m.spin_rad_s) && m.centre_m.cwiseAbs().maxCoeff() <= kMaxPosition_m &&
         m.inverse_mass_1_kg >= 0 && m.inverse_mass_1_kg <= kMaxMobility &&
         m.inverse_inertia.cwiseAbs().maxCoeff() <= kMaxMobility && std::abs(m.orientation.norm() - 1) <= kMaxNormError;
}

inline void archive(StateArchive& a, BodyMotion& m) {
  a(m.position_m), a(m.orientation), a(m.centre_m), a(m.velocity_m_s), a(m.spin_rad_s);
  a(m.inverse_mass_1_kg), a(m.inverse_inertia);
  a.require(!a.reads() || plausible(m), kImplausible);
}

// bodies, shapes: numbers of bodies and shapes in the world.
inline void archive(StateArchive& a, Manifold& m, std::size_t bodies, std::size_t shapes) {
  a.index(m.shape_a, shapes), a.index(m.shape_b, shapes), a.index(m.body_a, bodies), a.index(m.body_b, bodies);
  a(m.count);
  a.require(
      m.count >= 1 && m.count <= kMaxManifoldPoints && std::min({m.shape_a, m.shape_b, m.body_a, m.body_b}) >= 0,
      "the state holds a contact without points or bodies");
  for (ManifoldPoint& p : m.used())
    a(p.point_m), a(p.normal), a(p.depth_m), a(p.triangle_a), a(p.triangle_b), a(p.normal_force_N), a(p.friction);
}

}  // namespace tactus::sim
