// Moves a sounding source smoothly to a new contact point. Pure.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "audio_node/spatial/source_position.h"

namespace tactus::audio {

// One revolution a second, and the same rate for the logarithm of the distance. In blocks of kMaxBlock this
// distorts a tone of 440 Hz by less than -60 dB (spatialiser_test). Design.
inline constexpr float kGlide_rad_s = 2 * std::numbers::pi_v<float>;

// Moves from one point towards another around the origin: by at most `max_rad`, and by at most the same change of
// the logarithm of the distance. Between opposite points it takes one fixed way around. Realtime-safe: yes.
inline Eigen::Vector3f rotated_towards(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float max_rad) {
  const float r = from.norm(), to_r = to.norm();
  if (!(r > 1e-6f && to_r > 1e-6f)) return to;
  const Eigen::Vector3f a = from / r, b = to / to_r, normal = a.cross(b);
  const float angle = std::atan2(normal.norm(), a.dot(b));
  const float distance = std::max(angle, std::abs(std::log(to_r / r)));
  if (!(distance > max_rad)) return to;
  const float share = max_rad / distance;
  const bool has_plane = normal.norm() > 1e-5f;
  const Eigen::Vector3f axis = has_plane ? normal.normalized() : a.unitOrthogonal();
  return Eigen::AngleAxisf(share * angle, axis) * a * (r * std::pow(to_r / r, share));
}

// The place after a step towards another one, for an ear at ear_m in the world. Values that are not finite are
// passed through. Realtime-safe: yes.
inline SourcePosition glide(const SourcePosition& from, const SourcePosition& to, const Eigen::Vector3d& ear_m, float max_rad) {
  SourcePosition now = to;
  const Eigen::Vector3f a = from.distance_m * from.direction, b = to.distance_m * to.direction;
  if (a.allFinite() && b.allFinite()) {
    const Eigen::Vector3f p = rotated_towards(a, b, max_rad);
    if (p != b) now.distance_m = p.norm(), now.direction = p / now.distance_m;
  }
  if (from.source_m.allFinite() && to.source_m.allFinite() && from.source_m != to.source_m) {
    const Eigen::Vector3f wanted = (to.source_m - ear_m).cast<float>(),
                          p = rotated_towards((from.source_m - ear_m).cast<float>(), wanted, max_rad);
    if (p != wanted) now.source_m = ear_m + p.cast<double>();
  }
  return now;
}

}  // namespace tactus::audio
