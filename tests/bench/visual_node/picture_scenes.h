// Scenes for the measurement of frame cost, generated in code so that their numbers are exact.
#pragma once

#include <numbers>
#include <tactus/scene_t.hpp>

#include "visual_node/scene_view/relief.h"
#include "visual_node/scene_view/scene_view.h"

namespace tactus::bench {

struct PictureScene {
  scene_t scene;
  visual::Meshes meshes;
  visual::HeightMaps height_maps;
  int triangles = 0;  // number of triangles of the meshes
};

// Two balls of 10,608 triangles each on a floor, all of one rough material, before a camera that sees nothing else; a spot light that
// casts shadows and a point light.
PictureScene rough_balls();

// `count` boxes and balls, half of each, on a square grid that fills the picture.
PictureScene many_bodies(int count);

}  // namespace tactus::bench
