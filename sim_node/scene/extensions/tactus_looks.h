// How surfaces are drawn: the looks, shaders and passes of a scene, and what lies around it.
#pragma once

#include <optional>
#include <tactus/uniform_t.hpp>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// What <tactus:look>, SDF's <pbr> or a mesh file says of a look; what is not said comes from whoever is asked
// next.
struct LookWords {
  std::string name;
  std::optional<std::string> shader;
  std::optional<std::int64_t> colour_map, normal_map;  // 0: none, said so
  std::optional<double> reflectance;
  std::optional<std::vector<uniform_t>> uniforms;

  bool empty() const { return !shader && !colour_map && !normal_map && !reflectance && !uniforms; }
  // Fills in what is not said here.
  void add(const LookWords& others);
};

// Shaders, looks and passes that stand in <world>, and its environment. Refuses what is wrong, warns of a shader
// that is neither the scene's nor one of visual_node's.
void read_looks(LoadContext& context, const sdf::ElementPtr& world);

// Of one <tactus:look> that a visual wears: its own attributes, and those of the look of the world that it names.
LookWords read_look_words(LoadContext& context, const sdf::Element& element);

// Index of that look among the world's, each once; -1 when nothing is said.
int look_index(WorldDef& world, const LookWords& words);

}  // namespace tactus::sim
