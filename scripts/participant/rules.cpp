#include "scripts/participant/rules.h"

#include <stdexcept>

#include "sim_node/scene/load_sdf.h"

namespace tactus::participant {

Rules read_rules(const std::string& sdf_file) {
  std::vector<std::string> warnings;
  const sim::WorldDef world = sim::load_sdf(sdf_file, warnings);
  Rules rules;
  for (const sim::HoleDef& hole : world.holes) {
    Goal goal{.hole_m = hole.position_m, .hole_radius_m = hole.radius_m};
    goal.body = hole.ball;
    for (const sim::ShapeDef& shape : world.shapes)
      if (shape.body == hole.ball && shape.kind == sim::ShapeKind::kSphere) goal.ball_radius_m = shape.size_m.x();
    if (goal.ball_radius_m <= 0) throw std::runtime_error(sdf_file + ": what belongs into \"" + hole.name + "\" is no ball, which a player could push there");
    rules.goals.push_back(goal);
  }
  if (rules.goals.empty()) throw std::runtime_error(sdf_file + ": has no tactus:hole, so there is no game to play; dark_room.sdf has one");
  if (world.tools.empty()) throw std::runtime_error(sdf_file + ": has no tool that a hand could hold");
  rules.hand_radius_m = world.tools.front().radius_m;
  return rules;
}

}  // namespace tactus::participant
