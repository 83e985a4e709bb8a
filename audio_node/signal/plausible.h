// Whether a contact can be of this world. What cannot makes no sound: a blow that is played at some bounded
// strength instead would be a click that nothing has caused. The border (lcmtypes/valid.h) refuses what no message
// may say; this what no world does. Pure.
#pragma once

#include <cmath>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_point_t.hpp>
#include <tactus/contact_t.hpp>

namespace tactus::audio {

// Nothing in a room outruns sound in its air (20 degrees Celsius).
inline constexpr double kMaxSpeedOfWorld_m_s = 343;
// A lorry, and what a ton-heavy block weighs a hundred times; a tip of a micrometre; a town. Design.
inline constexpr double kMaxMassOfWorld_kg = 1e5, kMaxForceOfWorld_N = 1e6, kMaxCurvatureOfWorld_1_m = 1e6,
                        kMaxWayOfWorld_m = 1e4;

// Of no dry pair of materials there is more; it bounds how loud a scene can make what scrapes. Design.
inline constexpr double kMaxFriction = 2;

// True only of numbers: every comparison with a NaN is false.
template <class V>
bool within(const V& v, double most) {
  return std::abs(v.x) <= most && std::abs(v.y) <= most && std::abs(v.z) <= most;
}

// A unit vector, or nothing: far beyond rounding, since the border asks for 1 within 1e-2.
inline constexpr double kMaxDirection = 2;

// No body strikes itself.
inline bool plausible(const contact_event_t& e) {
  return e.body_a >= 0 && e.body_b >= 0 && e.body_a != e.body_b && e.approach_speed_m_s >= 0 &&
         e.approach_speed_m_s <= kMaxSpeedOfWorld_m_s && e.effective_mass_kg > 0 &&
         e.effective_mass_kg <= kMaxMassOfWorld_kg && e.curvature_1_m >= 0 &&
         e.curvature_1_m <= kMaxCurvatureOfWorld_1_m && within(e.point_m, kMaxWayOfWorld_m) &&
         within(e.normal, kMaxDirection);
}

inline bool plausible(const contact_t& c) {
  if (c.body_a < 0 || c.body_b < 0 || c.body_a == c.body_b || !within(c.normal, kMaxDirection) ||
      !(c.normal_force_N >= 0) || !(c.normal_force_N <= kMaxForceOfWorld_N) ||
      !within(c.sliding_velocity_m_s, kMaxSpeedOfWorld_m_s) ||
      !within(c.rolling_velocity_m_s, kMaxSpeedOfWorld_m_s))
    return false;
  for (const contact_point_t& p : c.points)
    if (!within(p.a_world_m, kMaxWayOfWorld_m) || !within(p.b_world_m, kMaxWayOfWorld_m) ||
        !within(p.a_body_m, kMaxWayOfWorld_m) || !within(p.b_body_m, kMaxWayOfWorld_m))
      return false;
  return true;
}

}  // namespace tactus::audio
