#include "scripts/simulated_player/rules.h"

#include <cmath>
#include <stdexcept>

#include "sim_node/scene/load_sdf.h"
#include "sim_node/scene/scene_folders.h"

namespace tactus::simulated_player {
namespace {

// The floor around the holes: static boxes with their top at the height of the rims, within a millimetre.
Eigen::AlignedBox2d floor_of(const sim::WorldDef& world, double rim_m) {
  Eigen::AlignedBox2d floor;
  for (const sim::ShapeDef& shape : world.shapes) {
    const sim::BodyDef& body = world.bodies[static_cast<std::size_t>(shape.body)];
    const Eigen::Vector3d at = (body.pose * shape.pose).translation(), half = shape.size_m / 2;
    if (!body.is_static || shape.kind != sim::ShapeKind::kBox || std::abs(at.z() + half.z() - rim_m) > 1e-3)
      continue;
    floor.extend(Eigen::AlignedBox2d((at - half).head<2>(), (at + half).head<2>()));
  }
  return floor;
}

}  // namespace

Rules read_rules(const std::string& sdf_file, const std::vector<std::string>& folders) {
  std::vector<std::string> warnings;
  const sim::WorldDef world = sim::load_sdf(sdf_file, warnings, {.folders = sim::scene_folders(folders)});
  Rules rules;
  for (const sim::HoleDef& hole : world.holes) {
    Goal goal{.hole_m = hole.position_m, .hole_radius_m = hole.radius_m};
    goal.body = hole.ball;
    for (const sim::ShapeDef& shape : world.shapes)
      if (shape.body == hole.ball && shape.kind == sim::ShapeKind::kSphere) goal.ball_radius_m = shape.size_m.x();
    if (goal.ball_radius_m <= 0)
      throw std::runtime_error(sdf_file + ": the body of hole \"" + hole.name +
                               "\" is not a ball; a player can push only balls");
    rules.goals.push_back(goal);
  }
  if (rules.goals.empty())
    throw std::runtime_error(sdf_file +
                             ": has no tactus:hole, so there is no game to play; dark_room.sdf has one");
  if (world.tools.empty()) throw std::runtime_error(sdf_file + ": has no tool for the hand");
  rules.hand_radius_m = world.tools.front().radius_m;
  rules.floor_m = floor_of(world, rules.goals.front().hole_m.z());
  rules.slope_m_s2 = {world.gravity_m_s2.x(), world.gravity_m_s2.y(), 0};
  return rules;
}

}  // namespace tactus::simulated_player
