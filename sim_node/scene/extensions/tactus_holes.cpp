#include "sim_node/scene/extensions/tactus_holes.h"

#include "sim_node/scene/sdf/attributes.h"

namespace tactus::sim {
namespace {

constexpr std::size_t kMaxHoles = 16;  // of a game_state_t
constexpr std::size_t kMaxNameLength = 64;

// The body of that name, or the only link of the model of that name; -1: not found.
int find_body(const LoadContext& context, const std::string& name) {
  if (const auto exact = context.body_of.find(name); exact != context.body_of.end()) return exact->second;
  int found = -1, links = 0;
  for (const auto& [scoped, body] : context.body_of)
    if (scoped.starts_with(name + "::")) found = body, ++links;
  return links == 1 ? found : -1;
}

HoleDef read_hole(const LoadContext& context, const sdf::Element& element) {
  Attributes attributes(context, element);
  HoleDef hole;
  hole.name = attributes.required_text("name");
  if (hole.name.size() > kMaxNameLength)
    context.reject(element, "has a name of more than 64 characters: shorten it");
  attributes.required_text("position");
  hole.position_m = *attributes.position("position");
  hole.radius_m = attributes.required_quantity("radius", "m", 1e-4, 100);
  hole.depth_m = attributes.quantity("depth", "m", 1e-4, 100).value_or(hole.depth_m);
  const std::string ball = attributes.required_text("ball");
  attributes.done();
  hole.ball = find_body(context, ball);
  if (hole.ball < 0)
    context.reject(element, "is for \"" + ball + "\": there is no such body, and no model of one link");
  const BodyDef& body = context.world.bodies[static_cast<std::size_t>(hole.ball)];
  if (body.is_static || body.tool >= 0)
    context.reject(element, "is for \"" + ball + "\", which cannot fall into it");
  return hole;
}

}  // namespace

void read_holes(LoadContext& context, const sdf::Element& world) {
  for (const sdf::Element& element : world.children("tactus:hole")) {
    if (context.world.holes.size() >= kMaxHoles)
      context.reject(element, "is one too many: a game has at most " + std::to_string(kMaxHoles) + " holes");
    context.world.holes.push_back(read_hole(context, element));
  }
}

}  // namespace tactus::sim
