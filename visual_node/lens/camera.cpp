#include "visual_node/lens/camera.h"

#include <cmath>

#include "lcmtypes/turn_between.h"

namespace tactus::visual {

Eigen::Matrix4f eye_from_camera() {
  Eigen::Matrix4f m;
  m << 0, -1, 0, 0,  // right is the camera's -y
      0, 0, 1, 0,    // up is its z
      -1, 0, 0, 0,   // backward is its -x
      0, 0, 0, 1;
  return m;
}

Eigen::Matrix4f perspective(double horizontal_fov_rad, double aspect, double near_m, double far_m) {
  const double f = 1 / std::tan(horizontal_fov_rad / 2);
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = f;
  m(1, 1) = f * aspect;
  m(2, 2) = (far_m + near_m) / (near_m - far_m);
  m(2, 3) = 2 * far_m * near_m / (near_m - far_m);
  m(3, 2) = -1;
  return m.cast<float>();
}

Camera make_camera(const Eigen::Isometry3d& pose, double horizontal_fov_rad, int width, int height, double near_m,
                   double far_m) {
  Camera c;
  c.projection = perspective(horizontal_fov_rad, static_cast<double>(width) / height, near_m, far_m);
  c.focal_px = static_cast<float>(0.5 * width / std::tan(horizontal_fov_rad / 2));
  return moved(c, pose);
}

Eigen::Vector3d drawing_origin(const Eigen::Vector3d& eye_m) {
  if (!eye_m.allFinite()) return Eigen::Vector3d::Zero();
  return (kOriginGrid_m * (eye_m / kOriginGrid_m).array().round()).matrix();
}

Camera moved(Camera camera, const Eigen::Isometry3d& pose) {
  camera.origin_m = drawing_origin(pose.translation());
  Eigen::Isometry3d about_origin = pose;
  about_origin.translation() -= camera.origin_m;
  camera.view = eye_from_camera() * about_origin.inverse().matrix().cast<float>();
  camera.eye = about_origin.translation().cast<float>();
  return camera;
}

Eigen::Matrix4f look_along(const Eigen::Vector3d& position, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d forward = direction.normalized();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = position;
  pose.linear() = turn_between(Eigen::Vector3d::UnitX(), forward).toRotationMatrix();
  return eye_from_camera() * pose.inverse().matrix().cast<float>();
}

}  // namespace tactus::visual
