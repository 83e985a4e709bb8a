// Archive functions shared by several states.
#pragma once

#include <cmath>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/manifold.h"
#include "sim_node/model/state_archive.h"

namespace tactus::sim {

// Whether a motion can be continued without an overflow. The bounds are far beyond any scene: a body that falls for a week
// stays within them.
inline bool plausible(const BodyMotion& m) {
  constexpr double kMaxPosition_m = 1e13, kMaxRate = 1e9, kMaxMobility = 1e12, kMaxNormError = 1e-3;
  return m.position_m.cwiseAbs().maxCoeff() <= kMaxPosition_m && m.centre_m.cwiseAbs().maxCoeff() <= kMaxPosition_m &&
         m.velocity_m_s.cwiseAbs().maxCoeff() <= kMaxRate && m.spin_rad_s.cwiseAbs().maxCoeff() <= kMaxRate &&
         m.inverse_mass_1_kg >= 0 && m.inverse_mass_1_kg <= kMaxMobility &&
         m.inverse_inertia.cwiseAbs().maxCoeff() <= kMaxMobility && std::abs(m.orientation.norm() - 1) <= kMaxNormError;
}

inline void archive(StateArchive& a, BodyMotion& m) {
  a(m.position_m), a(m.orientation), a(m.centre_m), a(m.velocity_m_s), a(m.spin_rad_s);
  a(m.inverse_mass_1_kg), a(m.inverse_inertia);
  a.require(!a.reads() || plausible(m), "the state holds a motion that no body can have");
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
