// The rules of the game, which a player receives before it begins: the hole of each ball, and the places of the holes. Read
// from the scene.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace tactus::simulated_player {

struct Goal {
  int body = -1;                    // of the ball, index in the scene
  Eigen::Vector3d hole_m{0, 0, 0};  // centre of the rim, world
  double hole_radius_m = 0;
  double ball_radius_m = 0;
};

struct Rules {
  std::vector<Goal> goals;   // in the order of the scene
  double hand_radius_m = 0;  // of the scene's first tool
  // The permitted area of the hand: over the floor that contains the holes. Empty: unlimited.
  Eigen::AlignedBox2d floor_m{};
  // Along the floor: the acceleration of a free ball, before the share of its rotation.
  Eigen::Vector3d slope_m_s2{0, 0, 0};
};

// folders: that the scene may read besides its own and those of the environment (sim_node/scene/scene_folders.h). Throws
// std::runtime_error with one sentence when the file holds no game of balls.
Rules read_rules(const std::string& sdf_file, const std::vector<std::string>& folders = {});

}  // namespace tactus::simulated_player
