// How thick the things of a scene are. Pure.
#pragma once

#include <tactus/scene_t.hpp>
#include <vector>

namespace tactus::thermal {

// By body, m: what lies behind the touched surface before the object ends, from its thickest shape: the shortest
// edge of a box, the diameter of what is round. Infinity: planes, meshes (their inside is not looked at) and
// bodies without a shape.
std::vector<double> thickness_of_bodies(const scene_t& scene);

}  // namespace tactus::thermal
