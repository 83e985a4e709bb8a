#include "visual_node/lens/off_axis.h"

#include <algorithm>

namespace tactus::visual {

Camera off_axis(const Wall& wall, const Eigen::Vector3d& eye, const Eigen::Vector3d& origin_m, int width, double near_m, double far_m) {
  const Eigen::Vector3d right = wall.right(), up = wall.up(), normal = wall.normal();
  const double before_m = (eye - wall.lower_left).dot(normal), away_m = std::max(before_m, kMinEyeDistance_m);
  const Eigen::Vector3d place = eye + (away_m - before_m) * normal;
  // Extent of the wall seen from there, projected onto the near plane.
  const auto near = [&](const Eigen::Vector3d& axis, const Eigen::Vector3d& corner) {
    return axis.dot(corner - place) * near_m / away_m;
  };
  const double l = near(right, wall.lower_left), r = near(right, wall.lower_right);
  const double b = near(up, wall.lower_left), t = near(up, wall.upper_left);
  Eigen::Matrix4d projection;
  projection << 2 * near_m / (r - l), 0, (r + l) / (r - l), 0,                           //
      0, 2 * near_m / (t - b), (t + b) / (t - b), 0,                                     //
      0, 0, (far_m + near_m) / (near_m - far_m), 2 * far_m * near_m / (near_m - far_m),  //
      0, 0, -1, 0;
  Eigen::Isometry3d eye_from_world = Eigen::Isometry3d::Identity();
  eye_from_world.linear() << right.transpose(), up.transpose(), normal.transpose();
  eye_from_world.translation() = eye_from_world.linear() * (origin_m - place);
  Camera camera;
  camera.projection = projection.cast<float>();
  camera.view = eye_from_world.matrix().cast<float>();
  camera.origin_m = origin_m;
  camera.eye = camera.about_origin(place);
  camera.focal_px = static_cast<float>(width * away_m / wall.width_m());
  return camera;
}

std::array<Eigen::Vector3d, 2> eyes(const Eigen::Isometry3d& head, double eye_distance_m) {
  const Eigen::Vector3d left = head.translation() + 0.5 * eye_distance_m * head.linear().col(1);
  return {left, 2 * head.translation() - left};
}

}  // namespace tactus::visual
