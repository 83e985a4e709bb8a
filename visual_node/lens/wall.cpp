#include "visual_node/lens/wall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "sync/text/csv.h"
#include "visual_node/lens/room_text.h"

namespace tactus::visual {
namespace {

constexpr const char* kColumns =
    "wall,lower_left_x_m,lower_left_y_m,lower_left_z_m,lower_right_x_m,lower_right_y_m,lower_right_z_m,"
    "upper_left_x_m,upper_left_y_m,upper_left_z_m";
// Corners are measured by hand, so this tolerance applies to right angles (as cosine): 3 mm on 3 m (design).
constexpr double kSquare = 1e-3;
constexpr double kMinSide_m = 0.01;
constexpr std::size_t kMaxWalls = 16;
constexpr std::uintmax_t kMaxBytes = 65536;  // design: far more than 16 walls take

[[noreturn]] void reject(const std::string& name, const std::string& why) {
  throw std::runtime_error("the room " + name + " " + why +
                           "; choose desk, cave4, cave6 or another file of walls");
}

template <std::size_t kCount>
std::optional<std::array<double, kCount>> numbers(const std::vector<std::string>& row) {
  std::array<double, kCount> all{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto number = sync::csv_number(row[i + 1]);
    if (!number) return {};
    all[i] = *number;
  }
  return all;
}

}  // namespace

Wall moved(const Wall& wall, const Eigen::Isometry3d& by) {
  return {wall.name, by * wall.lower_left, by * wall.lower_right, by * wall.upper_left};
}

const Wall* Room::find_wall(const std::string& name) const {
  const auto found = std::find_if(walls.begin(), walls.end(), [&](const Wall& w) { return w.name == name; });
  return found == walls.end() ? nullptr : &*found;
}

const Wall& Room::chosen_wall(const std::string& room, const std::string& wall) const {
  if (wall == "first") return walls.front();
  if (const Wall* const found = find_wall(wall)) return *found;
  std::string all;
  for (const Wall& w : walls) all += (all.empty() ? "" : ", ") + w.name;
  throw std::runtime_error("the room " + room + " has no wall " + wall + ", only " + all);
}

Room parse_room(const std::string& csv, const std::string& name) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  if (sync::csv_cells(line) != sync::csv_cells(kColumns))
    reject(name, std::string("does not begin in line 1 with ") + kColumns);
  Room room;
  bool has_eye = false;
  for (int number = 2; std::getline(lines, line); ++number) {
    const std::vector<std::string> row = sync::csv_cells(line);
    if (sync::is_blank(row)) continue;
    const std::string which = "line " + std::to_string(number);
    if (row.size() != 10) reject(name, "does not have ten columns in " + which);
    if (row[0] == "eye") {
      const auto at = numbers<3>(row);
      if (!at || has_eye) reject(name, "does not have one row eye with three numbers");
      room.eye = {(*at)[0], (*at)[1], (*at)[2]};
      has_eye = true;
      continue;
    }
    const auto n = numbers<9>(row);
    if (row[0].empty() || !n) reject(name, "does not have a name and nine numbers in " + which);
    const Wall wall{row[0], {(*n)[0], (*n)[1], (*n)[2]}, {(*n)[3], (*n)[4], (*n)[5]}, {(*n)[6], (*n)[7], (*n)[8]}};
    if (!(wall.width_m() >= kMinSide_m) || !(wall.height_m() >= kMinSide_m) ||
        !(std::abs(wall.right().dot(wall.up())) <= kSquare))
      reject(name, "does not have a rectangle of at least 1 cm in " + which + " (" + wall.name + ")");
    if (room.find_wall(wall.name)) reject(name, "has two walls " + wall.name);
    room.walls.push_back(wall);
    if (room.walls.size() > kMaxWalls) reject(name, "has more than " + std::to_string(kMaxWalls) + " walls");
  }
  if (room.walls.empty()) reject(name, "has no wall");
  return room;
}

Room load_room(const std::string& name_or_path) {
  if (const std::string_view known = room_text(name_or_path + ".csv"); !known.empty())
    return parse_room(std::string(known), name_or_path);
  const auto text = sync::read_small_file(name_or_path, kMaxBytes);
  if (!text) reject(name_or_path, "cannot be read");
  return parse_room(*text, name_or_path);
}

}  // namespace tactus::visual
