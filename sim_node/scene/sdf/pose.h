// Poses as SDFormat composes them. The formulas and their order of operations are those of libignition-math 6 (Pose3,
// Quaternion), so that a scene has the same world to the bit as with libsdformat 12.
#pragma once

#include <Eigen/Geometry>

namespace tactus::sim::sdf {

struct Rotation {
  double w = 1, x = 0, y = 0, z = 0;

  // Roll about x, then pitch about y, then yaw about z, all fixed axes; rad.
  static Rotation from_euler(double roll, double pitch, double yaw);
  Rotation operator*(const Rotation& other) const;
  // The identity for a rotation of norm 0.
  Rotation inverse() const;
  Eigen::Vector3d operator*(const Eigen::Vector3d& v) const;
};

// a * b: the pose b, given in the frame a, in the frame that a is given in.
struct Pose {
  Eigen::Vector3d position_m{0, 0, 0};
  Rotation rotation;

  Pose operator*(const Pose& other) const;
  Pose inverse() const;
  Eigen::Isometry3d to_eigen() const;
};

}  // namespace tactus::sim::sdf
