// The walls of a room of screens around the user.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace tactus::visual {

// A rectangle, as seen by the user inside. m, in the frame of the room: x ahead, y to the left, z up. The origin is
// the middle of the floor; for a desktop screen, the middle of the screen.
struct Wall {
  std::string name;
  Eigen::Vector3d lower_left, lower_right, upper_left;

  double width_m() const { return (lower_right - lower_left).norm(); }
  double height_m() const { return (upper_left - lower_left).norm(); }
  Eigen::Vector3d right() const { return (lower_right - lower_left).normalized(); }
  Eigen::Vector3d up() const { return (upper_left - lower_left).normalized(); }
  // Towards the user.
  Eigen::Vector3d normal() const { return right().cross(up()); }
};

Wall moved(const Wall& wall, const Eigen::Isometry3d& by);

struct Room {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  // the user's eye while it is not tracked
  std::vector<Wall> walls;

  // Returns null when there is no wall of that name.
  const Wall* find_wall(const std::string& name) const;
  // The wall of the setting `wall`, where "first" is the first one. room: its name or path. Throws std::runtime_error with one
  // sentence when there is no such wall.
  const Wall& chosen_wall(const std::string& room, const std::string& wall) const;
};

// Loads desk, cave4 (left, front, right, floor), cave6 (also back and ceiling), or a CSV file with one row a wall.
// Reads a file: do not call in a loop. Throws std::runtime_error with one sentence.
Room load_room(const std::string& name_or_path);
// Parses the text of such a file: wall, then x, y and z of three corners; and one row `eye` with three numbers.
// `name` identifies the room in error messages.
Room parse_room(const std::string& csv, const std::string& name);

}  // namespace tactus::visual
