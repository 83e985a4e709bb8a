// Archive functions shared by several states.
#pragma once

#include "sim_node/model/body_motion.h"
#include "sim_node/model/manifold.h"
#include "sim_node/model/state_archive.h"

namespace tactus::sim {

inline void archive(StateArchive& a, BodyMotion& m) {
  a(m.position_m), a(m.orientation), a(m.centre_m), a(m.velocity_m_s), a(m.spin_rad_s);
  a(m.inverse_mass_1_kg), a(m.inverse_inertia);
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
