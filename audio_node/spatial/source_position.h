// Where a sound comes from, for the one who hears it. Pure.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace tactus::audio {

// In the listener's frame: x ahead, y to the left, z up.
struct SourcePosition {
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();  // unit
  float distance_m = 1;
  // Where it is in the world, so that it stays there while the listener moves; no number: nobody has said.
  Eigen::Vector3f source_m = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
};

struct Listener {
  Eigen::Isometry3f T_W_listener = Eigen::Isometry3f::Identity();
  float nearest_m = 0;  // sources nearer than this are heard as from here

  bool operator==(const Listener& other) const {
    return T_W_listener.matrix() == other.T_W_listener.matrix() && nearest_m == other.nearest_m;
  }
};

// The same place for a listener who has moved. Realtime-safe: yes.
inline SourcePosition heard_by(const Listener& listener, const SourcePosition& place) {
  if (!place.source_m.allFinite()) return place;
  const Eigen::Vector3f p = listener.T_W_listener.inverse() * place.source_m;
  const float r = p.norm();
  SourcePosition now = place;
  if (r > 1e-6f) now.direction = p / r;
  now.distance_m = std::max(r, listener.nearest_m);
  return now;
}

}  // namespace tactus::audio
