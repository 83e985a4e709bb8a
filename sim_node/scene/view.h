// Camera and listener of a scene, ambient light and background.
#pragma once

#include <sdf/World.hh>

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Camera: <tactus:camera>, else that of <gui>, else the first camera sensor, else a view of all bodies. Listener:
// <tactus:listener>, else at the camera. Ambient light and background: <scene>, or the defaults of SDF. `world` is
// null for a file that contains only a model.
void read_view(LoadContext& context, const sdf::World* world, const sdf::ElementPtr& element);

}  // namespace tactus::sim
