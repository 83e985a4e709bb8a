// A bounding sphere on its straight way, and how far the true way may leave that: what grouping compares. Pure.
#pragma once

#include <Eigen/Core>

namespace tactus::sim {

struct SweptSphere {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  // at the beginning of the horizon
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  double radius_m = 0;
  double pad_m = 0;  // its centre stays so near to the straight way
};

// When the centres first are so near, s; -1: never within the horizon.
double first_meeting_s(const SweptSphere& a, const SweptSphere& b, double distance_m, double horizon_s);

// Smallest distance of the straight ways themselves, each at an instant of its own: the axes of the capsules that
// Kim et al. 2005, section 4, intersect. Never larger than the closest approach in time. Source of the method:
// Ericson 2005, Real-Time Collision Detection, 5.1.9.
double closest_axes_m(const SweptSphere& a, const SweptSphere& b, double horizon_s);

// What holds the sphere during the whole horizon.
struct Bounds {
  Eigen::Vector3d least_m, most_m;
  bool meets(const Bounds& o) const {
    return (least_m.array() <= o.most_m.array()).all() && (o.least_m.array() <= most_m.array()).all();
  }
};
Bounds bounds_of(const SweptSphere& s, double horizon_s);

}  // namespace tactus::sim
