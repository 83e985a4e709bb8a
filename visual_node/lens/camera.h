// Camera matrices: converts SDF's camera convention to OpenGL's.
#pragma once

#include <Eigen/Geometry>

namespace tactus::visual {

struct Camera {
  Eigen::Matrix4f view = Eigen::Matrix4f::Identity();        // T_eye_world; the eye looks along -z, y up
  Eigen::Matrix4f projection = Eigen::Matrix4f::Identity();  // eye to clip space
  Eigen::Vector3f eye = Eigen::Vector3f::Zero();             // m, world
  float focal_px = 1;  // pixels that a length of 1 m covers at a distance of 1 m

  Eigen::Matrix4f clip_from_world() const { return projection * view; }
};

// T_eye_camera: an SDF camera looks along +x with z up, OpenGL's eye along -z with y up.
Eigen::Matrix4f eye_from_camera();

// OpenGL's perspective with the horizontal field of view given: depth near_m .. far_m to -1 .. 1.
Eigen::Matrix4f perspective(double horizontal_fov_rad, double aspect, double near_m, double far_m);

// pose: T_world_camera, SDF convention.
Camera make_camera(const Eigen::Isometry3d& pose, double horizontal_fov_rad, int width, int height, double near_m,
                   double far_m);

// The same camera at another pose.
Camera moved(Camera camera, const Eigen::Isometry3d& pose);

// T_eye_world of a lamp at `position` that shines along `direction`; its roll is arbitrary.
Eigen::Matrix4f look_along(const Eigen::Vector3d& position, const Eigen::Vector3d& direction);

}  // namespace tactus::visual
