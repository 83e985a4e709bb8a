#include "visual_node/lens/lens.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lcmtypes/vectors.h"
#include "visual_node/lens/off_axis.h"

namespace tactus::visual {
namespace {

// Horizontal field of view of a scene without one: the default of the SDF camera, 1.047 rad.
constexpr double kDefaultFov_rad = 1.047;

// A room of several walls has a level floor: it turns about the vertical only, with the heading of the camera.
Eigen::Isometry3d heading(const Eigen::Isometry3d& camera) {
  const Eigen::Vector3d ahead = camera.linear().col(0);
  Eigen::Isometry3d level = Eigen::Isometry3d::Identity();
  level.linear() =
      Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  level.translation() = camera.translation();
  return level;
}

}  // namespace

Lens::Lens(const scene_t& scene, const Settings& settings, int width, int height)
    : width_(width),
      near_m_(settings.near_m),
      far_m_(std::max(settings.far_m, 2 * settings.near_m)),
      default_pose_(to_eigen(scene.camera)) {
  const double fov = settings.fov_rad > 0       ? settings.fov_rad
                     : scene.camera_fov_rad > 0 ? scene.camera_fov_rad
                                                : kDefaultFov_rad;
  default_camera_ = make_camera(default_pose_, std::min(fov, 3.0), width, height, near_m_, far_m_);
  half_width_ = std::tan(std::min(fov, 3.0) / 2);
  half_height_ = half_width_ * height / width;
  try {
    place_room(scene, settings);
  } catch (const std::runtime_error& wrong) {
    warning_ = std::string(wrong.what()) + "; the scene's camera is used instead";
  }
}

void Lens::place_room(const scene_t& scene, const Settings& settings) {
  if (settings.room == "none") return;
  const Room room = load_room(settings.room);
  const Eigen::Isometry3d camera = to_eigen(scene.camera);
  wall_ = moved(room.chosen_wall(settings.room, settings.wall), (room.walls.size() > 1 ? heading(camera) : camera) * Eigen::Translation3d(-room.eye));
}

Camera Lens::camera(const std::optional<Eigen::Isometry3d>& head) const {
  const Eigen::Vector3d eye = head.value_or(default_pose_).translation();
  if (wall_) return off_axis(*wall_, eye, drawing_origin(eye), width_, near_m_, far_m_);
  return head ? moved(default_camera_, *head) : default_camera_;
}

std::array<Camera, 2> Lens::eyes(const std::optional<Eigen::Isometry3d>& head, double eye_distance_m,
                                 double window_m) const {
  const Eigen::Isometry3d at = head.value_or(default_pose_);
  const Wall window{"", at * Eigen::Vector3d(window_m, half_width_ * window_m, -half_height_ * window_m),
                    at * Eigen::Vector3d(window_m, -half_width_ * window_m, -half_height_ * window_m),
                    at * Eigen::Vector3d(window_m, half_width_ * window_m, half_height_ * window_m)};
  const Wall& wall = wall_ ? *wall_ : window;
  const auto [left, right] = visual::eyes(at, eye_distance_m);
  const Eigen::Vector3d origin_m = drawing_origin(at.translation());  // of both eyes, and of camera()
  return {off_axis(wall, left, origin_m, width_, near_m_, far_m_), off_axis(wall, right, origin_m, width_, near_m_, far_m_)};
}

}  // namespace tactus::visual
