// Bounding sphere in linear motion with a bound on the deviation, for the grouping of bodies. Pure.
#pragma once

#include <Eigen/Core>

namespace tactus::sim {

struct SweptSphere {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  // at the start of the horizon
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  double radius_m = 0;
  double pad_m = 0;  // maximum deviation of the centre from the linear motion
};

// First time at which the centres are within the distance, s; -1: not within the horizon.
double first_contact_time_s(const SweptSphere& a, const SweptSphere& b, double distance_m, double horizon_s);

// Minimum distance of the two paths as line segments, independent of time: the axes of the capsules that Kim et al.
// 2005, section 4, intersect. At most the closest approach in time. Method: Ericson 2005, Real-Time Collision
// Detection, 5.1.9.
double axis_distance_m(const SweptSphere& a, const SweptSphere& b, double horizon_s);

// Axis-aligned box around the sphere during the whole horizon.
struct Bounds {
  Eigen::Vector3d min_m, max_m;
  bool overlaps(const Bounds& o) const {
    return (min_m.array() <= o.max_m.array()).all() && (o.min_m.array() <= max_m.array()).all();
  }
};
Bounds bounds_of(const SweptSphere& s, double horizon_s);

}  // namespace tactus::sim
