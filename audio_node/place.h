// Where a sound comes from, for the one who hears it. Pure.
#pragma once

#include <Eigen/Core>

namespace tactus::audio {

// In the listener's frame: x ahead, y to the left, z up.
struct Place {
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();  // unit
  float distance_m = 1;
};

}  // namespace tactus::audio
