// The walls that pictures are thrown on or shown by, around a person.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace tactus::visual {

// A rectangle, as the person inside sees it. m, in the frame of the room: x ahead, y to the left, z up, from the
// middle of its floor; of a screen on a desk from the middle of that.
struct Wall {
  std::string name;
  Eigen::Vector3d lower_left, lower_right, upper_left;

  double width_m() const { return (lower_right - lower_left).norm(); }
  double height_m() const { return (upper_left - lower_left).norm(); }
  Eigen::Vector3d right() const { return (lower_right - lower_left).normalized(); }
  Eigen::Vector3d up() const { return (upper_left - lower_left).normalized(); }
  // Towards the person.
  Eigen::Vector3d normal() const { return right().cross(up()); }
};

Wall moved(const Wall& wall, const Eigen::Isometry3d& by);

struct Room {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  // where the person's is, while nobody tracks it
  std::vector<Wall> walls;

  // Null: there is none of that name.
  const Wall* named(const std::string& name) const;
};

// desk, cave4 (left, front, right, floor), cave6 (and back and ceiling), or a CSV file of one row a wall. Reads a
// file: not in a loop. Throws std::runtime_error with one sentence.
Room load_room(const std::string& name_or_path);
// The text of such a file: wall, then x, y and z of three corners; and one row `eye` with three numbers. `name` is
// what a sentence calls it.
Room parse_room(const std::string& csv, const std::string& name);

}  // namespace tactus::visual
