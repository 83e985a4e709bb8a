// Appearance of surfaces: looks, shaders and passes of a scene, and its environment.
#pragma once

#include <optional>
#include <tactus/uniform_t.hpp>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// A look from <tactus:look>, from <pbr> of SDF or from a mesh file; missing values come from the next source.
struct LookAttributes {
  std::string name;
  std::optional<std::string> shader;
  std::optional<std::int64_t> colour_map, normal_map;  // 0: explicitly none
  std::optional<double> reflectance;
  std::optional<std::vector<uniform_t>> uniforms;

  bool empty() const { return !shader && !colour_map && !normal_map && !reflectance && !uniforms; }
  // Fills in the values that are missing here.
  void add(const LookAttributes& others);
};

// Reads the shaders, looks, passes and environment of <world>. Rejects invalid values, and warns of a shader that
// belongs neither to the scene nor to visual_node.
void read_looks(LoadContext& context, const sdf::Element& world);

// Reads the <tactus:look> of a visual: its own attributes, and those of the named look of the world.
LookAttributes read_visual_look(LoadContext& context, const sdf::Element& element);

// Index of that look in the world, without duplicates; -1: empty look.
int look_index(LoadContext& context, const LookAttributes& attributes);

}  // namespace tactus::sim
