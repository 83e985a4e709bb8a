// Plausibility of contacts. An implausible contact is silent: a blow clamped to some strength would be a click
// without a cause. The message validation (lcmtypes/valid.h) rejects invalid messages; this rejects impossible
// physics. Pure.
#pragma once

#include <cmath>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_point_t.hpp>
#include <tactus/contact_t.hpp>

namespace tactus::audio {

// Nothing in a room moves faster than sound in its air (20 degrees Celsius).
inline constexpr double kMaxPlausibleSpeed_m_s = 343;
// The mass of a lorry; a hundred times the weight of a block of a ton; a tip of a micrometre; twice the distance from the origin
// at which a scene may place a body (sim_node/scene/sdf/load_context.cpp). Design.
inline constexpr double kMaxPlausibleMass_kg = 1e5, kMaxPlausibleForce_N = 1e6, kMaxPlausibleCurvature_1_m = 1e6,
                        kMaxPlausiblePosition_m = 2e6;

// No dry pair of materials has more; it bounds the loudness of scrapes that a scene can request. Design.
inline constexpr double kMaxFriction = 2;

// False for NaN: every comparison with a NaN is false.
template <class V>
bool within(const V& v, double max) {
  return std::abs(v.x) <= max && std::abs(v.y) <= max && std::abs(v.z) <= max;
}

// A unit vector or zero, with a wide margin: the message validation requires 1 within 1e-2.
inline constexpr double kMaxDirection = 2;

// A body cannot strike itself.
inline bool plausible(const contact_event_t& e) {
  return e.body_a >= 0 && e.body_b >= 0 && e.body_a != e.body_b && e.approach_speed_m_s >= 0 &&
         e.approach_speed_m_s <= kMaxPlausibleSpeed_m_s && e.effective_mass_kg > 0 &&
         e.effective_mass_kg <= kMaxPlausibleMass_kg && e.curvature_1_m >= 0 &&
         e.curvature_1_m <= kMaxPlausibleCurvature_1_m && within(e.point_m, kMaxPlausiblePosition_m) &&
         within(e.normal, kMaxDirection);
}

inline bool plausible(const contact_t& c) {
  if (c.body_a < 0 || c.body_b < 0 || c.body_a == c.body_b || !within(c.normal, kMaxDirection) ||
      !(c.normal_force_N >= 0) || !(c.normal_force_N <= kMaxPlausibleForce_N) ||
      !within(c.sliding_velocity_m_s, kMaxPlausibleSpeed_m_s) ||
      !within(c.rolling_velocity_m_s, kMaxPlausibleSpeed_m_s))
    return false;
  for (const contact_point_t& p : c.points)
    if (!within(p.a_world_m, kMaxPlausiblePosition_m) || !within(p.b_world_m, kMaxPlausiblePosition_m) ||
        !within(p.a_body_m, kMaxPlausiblePosition_m) || !within(p.b_body_m, kMaxPlausiblePosition_m))
      return false;
  return true;
}

}  // namespace tactus::audio
