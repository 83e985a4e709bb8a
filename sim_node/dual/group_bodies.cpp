#include "sim_node/dual/group_bodies.h"

#include <algorithm>

#include "sim_node/collision/closest_surface.h"

namespace tactus::sim {

std::vector<double> body_radii(const WorldDef& world, MeshTrees& trees) {
  std::vector<double> out(world.bodies.size(), 0);
  for (const ShapeDef& s : world.shapes) {
    const auto body = static_cast<std::size_t>(s.body);
    if (world.bodies[body].is_static) continue;
    const ClosestSurface surface(s, s.kind == ShapeKind::kMesh ? trees.triangles(s, world) : nullptr);
    const double from_centre = (s.pose * surface.centre() - world.bodies[body].centre_of_mass_m).norm();
    // A moving plane is a plate of its size.
    const double bound = s.kind == ShapeKind::kPlane ? 0.5 * s.size_m.norm() : surface.bound_m();
    out[body] = std::max(out[body], from_centre + bound);
  }
  return out;
}

std::vector<GroupBody> group_bodies(const WorldDef& def, const impulse::World& world, MeshTrees& trees) {
  const std::vector<double> radii = body_radii(def, trees);
  std::vector<GroupBody> out;
  std::vector<int> links(static_cast<std::size_t>(world.units()), 0), system(links.size(), -1);
  for (int body = 0; body < static_cast<int>(def.bodies.size()); ++body)
    if (const int unit = world.unit_of(body); unit >= 0) ++links[static_cast<std::size_t>(unit)];
  int systems = 0;
  for (std::size_t unit = 0; unit < links.size(); ++unit)
    if (links[unit] > 1) system[unit] = systems++;
  for (std::size_t i = 0; i < def.bodies.size(); ++i) {
    const int unit = world.unit_of(static_cast<int>(i));
    GroupBody b;
    b.radius_m = radii[i];
    if (unit >= 0) {
      b.inverse_mass_1_kg = 1 / def.bodies[i].mass_kg;
      b.system = system[static_cast<std::size_t>(unit)];
    }
    out.push_back(b);
  }
  return out;
}

Settings for_haptic_group(Settings s) {
  if (s.solver != "penalty_explicit") s.solver = "penalty";
  return s;
}

Settings for_visual_group(Settings s) {
  s.solver = "impulse";
  return s;
}

}  // namespace tactus::sim
