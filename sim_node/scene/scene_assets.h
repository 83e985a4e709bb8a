// Assets of a world for the renderers: the scene, its meshes, images, shaders and the SDF text, each named by its
// hash.
#pragma once

#include <vector>

#include "sim_node/model/world_def.h"

namespace tactus::sim {

// One SCENE, one MESH per mesh and heightfield, one IMAGE per picture, one SHADER per text, one SDF. step_ns as in
// scene_t.
std::vector<sync::Asset> make_assets(const WorldDef& world, std::int64_t step_ns = 1'000'000);

}  // namespace tactus::sim
