// The view of one process: the scene's camera, or one wall of a room around the user. Pure after construction.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <tactus/scene_t.hpp>

#include "visual_node/lens/camera.h"
#include "visual_node/lens/wall.h"
#include "visual_node/settings.gen.h"

namespace tactus::visual {

class Lens {
 public:
  // Reads the file of the room, if one is set: do not call in a loop.
  Lens(const scene_t& scene, const Settings& settings, int width, int height);

  // head: T_world_head, x ahead, z up; nothing: the pose of the scene's camera. All cameras of one head have the same origin.
  Camera camera(const std::optional<Eigen::Isometry3d>& head) const;
  // Cameras of the left and the right eye. Without a wall both look through a window of the picture's size, which
  // moves with the head: both eyes see a point at the window's distance at the same place.
  std::array<Camera, 2> eyes(const std::optional<Eigen::Isometry3d>& head, double eye_distance_m,
                             double window_m) const;
  // One sentence about a room that cannot be used; empty: none. Then the scene's camera is used.
  const std::string& warning() const { return warning_; }

 private:
  void place_room(const scene_t& scene, const Settings& settings);

  int width_;
  double half_width_, half_height_;  // of the scene's camera, tangents of the half angles
  double near_m_, far_m_;
  Camera default_camera_;
  Eigen::Isometry3d default_pose_;  // T_world_camera, of the scene
  std::optional<Wall> wall_;  // in the world frame
  std::string warning_;
};

}  // namespace tactus::visual
