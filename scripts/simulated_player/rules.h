// What a player is told before the game: which ball belongs into which hole, and where the holes are. Read from
// the scene.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace tactus::participant {

struct Goal {
  int body = -1;                    // of the ball, index in the scene
  Eigen::Vector3d hole_m{0, 0, 0};  // centre of the rim, world
  double hole_radius_m = 0;
  double ball_radius_m = 0;
};

struct Rules {
  std::vector<Goal> goals;   // in the order of the scene
  double hand_radius_m = 0;  // of the scene's first tool
  // Where a hand may go: over the floor that holds the holes. Empty: anywhere.
  Eigen::AlignedBox2d floor_m{};
  Eigen::Vector3d slope_m_s2{
      0, 0, 0};  // along the floor: what accelerates a ball that is let go, before its rolling takes its share
};

// Throws std::runtime_error with one sentence when the file holds no game of balls.
Rules read_rules(const std::string& sdf_file);

}  // namespace tactus::participant
