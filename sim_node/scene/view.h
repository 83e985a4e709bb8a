// From where the scene is seen and heard.
#pragma once

#include <sdf/World.hh>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Camera: <tactus:camera>, else that of <gui>, else the first camera sensor, else one that has all bodies in view.
// Listener: <tactus:listener>, else at the camera. Light from everywhere and background from <scene>, or SDF's defaults.
// `world` may be null: a file that holds a model only.
void read_view(LoadContext& context, const sdf::World* world, const sdf::ElementPtr& element);

}  // namespace tactus::sim
