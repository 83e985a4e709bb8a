// Camera matrices: converts SDF's camera convention to OpenGL's.
#pragma once

#include <Eigen/Geometry>

namespace tactus::visual {

// Graphics hardware computes in single precision, whose steps are 3 cm at 300 km. Everything that is drawn is therefore given in the
// axes of the world about an origin near the eye: a corner of a grid of this size. Its steps are then at most 4 um near the eye. A power
// of two, so that patterns of 1 m and its halves stay where they are when the origin changes. Design.
inline constexpr double kOriginGrid_m = 64;

// The corner of that grid nearest to the eye, m, world: the origin of a picture. The origin of the world, when the eye is within half
// a cell of it.
Eigen::Vector3d drawing_origin(const Eigen::Vector3d& eye_m);

struct Camera {
  Eigen::Matrix4f view = Eigen::Matrix4f::Identity();        // T_eye_world about the origin; the eye looks along -z, y up
  Eigen::Matrix4f projection = Eigen::Matrix4f::Identity();  // eye to clip space
  Eigen::Vector3f eye = Eigen::Vector3f::Zero();             // m, axes of the world, about the origin
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();        // m, world: origin of the picture
  float focal_px = 1;  // pixels that a length of 1 m covers at a distance of 1 m

  // From places about the origin.
  Eigen::Matrix4f clip_from_world() const { return projection * view; }
  // A place in the world about the origin, m.
  Eigen::Vector3f about_origin(const Eigen::Vector3d& place_m) const { return (place_m - origin_m).cast<float>(); }
};

// T_eye_camera: an SDF camera looks along +x with z up, OpenGL's eye along -z with y up.
Eigen::Matrix4f eye_from_camera();

// OpenGL's perspective with the horizontal field of view given: depth near_m .. far_m to -1 .. 1.
Eigen::Matrix4f perspective(double horizontal_fov_rad, double aspect, double near_m, double far_m);

// pose: T_world_camera, SDF convention.
Camera make_camera(const Eigen::Isometry3d& pose, double horizontal_fov_rad, int width, int height, double near_m,
                   double far_m);

// The same camera at another pose, T_world_camera.
Camera moved(Camera camera, const Eigen::Isometry3d& pose);

// T_eye_world of a lamp at `position` that shines along `direction`; its roll is arbitrary.
Eigen::Matrix4f look_along(const Eigen::Vector3d& position, const Eigen::Vector3d& direction);

}  // namespace tactus::visual
