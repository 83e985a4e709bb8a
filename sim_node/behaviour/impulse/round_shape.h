// Shapes that rotation leaves as they are: a ball about its centre, a cylinder or capsule about its axis. Where such a shape
// touches another surface depends on the place of its centre and axis, and not on how far it has turned about them.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>

namespace tactus::sim::impulse {

struct RoundShape {
  // kCapsule: a segment with a radius; a ball is one of no length.
  enum class Kind { kOther, kCapsule, kCylinder };
  Kind kind = Kind::kOther;
  Eigen::Vector3d centre_m{0, 0, 0};  // from the centre of mass of the body
  Eigen::Vector3d axis{0, 0, 1};      // unit
  double half_length_m = 0;           // of the segment of a capsule

  RoundShape turned(const Eigen::Quaterniond& by) const { return {kind, by * centre_m, by * axis, half_length_m}; }

  // Movement of a point of contact, arm_m from the centre of mass, when the body turns about that centre by turn_rad, m.
  Eigen::Vector3d displacement_m(const Eigen::Vector3d& arm_m, const Eigen::Vector3d& turn_rad) const {
    if (kind == Kind::kOther) return moved(arm_m, turn_rad);
    const Eigen::Vector3d in_shape = arm_m - centre_m;
    if (kind == Kind::kCapsule) return moved(centre_m + axis * std::clamp(axis.dot(in_shape), -half_length_m, half_length_m), turn_rad);
    return moved(centre_m, turn_rad) + moved(in_shape, turn_rad - axis * axis.dot(turn_rad));
  }

 private:
  static Eigen::Vector3d moved(const Eigen::Vector3d& arm_m, const Eigen::Vector3d& turn_rad) {
    const double angle = turn_rad.norm();
    if (!(angle > 0)) return Eigen::Vector3d::Zero();
    return Eigen::AngleAxisd(angle, turn_rad / angle).toRotationMatrix() * arm_m - arm_m;
  }
};

}  // namespace tactus::sim::impulse
