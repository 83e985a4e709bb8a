// Position of a sound source relative to the listener. Pure.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace tactus::audio {

// In the frame of the listener: x ahead, y to the left, z up.
struct SourcePosition {
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();  // unit
  float distance_m = 1;
  // Position in the world, so that it stays there while the listener moves; NaN: not known. In double precision, because
  // only its difference to the listener matters, wherever the scene lies.
  Eigen::Vector3d source_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
};

struct Listener {
  Eigen::Isometry3d T_W_listener = Eigen::Isometry3d::Identity();
  float nearest_m = 0;  // nearer sources count as at this distance

  bool operator==(const Listener& other) const {
    return T_W_listener.matrix() == other.T_W_listener.matrix() && nearest_m == other.nearest_m;
  }
};

// The same place for a listener who has moved. Realtime-safe: yes.
inline SourcePosition relative_to_listener(const Listener& listener, const SourcePosition& place) {
  if (!place.source_m.allFinite()) return place;
  const Eigen::Vector3f p = (listener.T_W_listener.inverse() * place.source_m).cast<float>();
  const float r = p.norm();
  SourcePosition now = place;
  if (r > 1e-6f) now.direction = p / r;
  now.distance_m = std::max(r, listener.nearest_m);
  return now;
}

}  // namespace tactus::audio
