// What one process sees of a scene: through the scene's camera, or through one wall of a room around its person.
// Pure once it is made.
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
  // Reads the file of the room, where one is set: not in a loop.
  Lens(const scene_t& scene, const Settings& settings, int width, int height);

  // head: T_world_head, x ahead, z up; nothing: it is where the scene's camera is.
  Camera at(const std::optional<Eigen::Isometry3d>& head) const;
  // Of the left eye and the right one. Without a wall they look through a window as large as the picture, which
  // the head carries before it: what is as far away as that is seen at one place by both.
  std::array<Camera, 2> eyes(const std::optional<Eigen::Isometry3d>& head, double apart_m, double window_m) const;
  // One sentence; empty when nothing is wrong. Otherwise it is the scene's camera.
  const std::string& trouble() const { return trouble_; }

 private:
  void stand_room(const scene_t& scene, const Settings& settings);

  int width_;
  double half_width_, half_height_;  // of the scene's camera, tangents
  double near_m_, far_m_;
  Camera plain_;
  Eigen::Isometry3d rest_;    // T_world_camera, of the scene
  std::optional<Wall> wall_;  // in the world
  std::string trouble_;
};

}  // namespace tactus::visual
