// Thickness of the bodies of a scene. Pure.
#pragma once

#include <tactus/scene_t.hpp>
#include <vector>

namespace tactus::thermal {

// Returns for each body, m, the depth behind the touched surface. It is taken from the thickest shape: the
// shortest edge of a box, the diameter of a round shape. Infinity: planes, meshes (their inside is not examined)
// and bodies without a shape.
std::vector<double> thickness_of_bodies(const scene_t& scene);

}  // namespace tactus::thermal
