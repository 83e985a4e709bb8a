// Camera and listener of a scene, ambient light and background.
#pragma once

#include "sim_node/scene/sdf/load_context.h"

namespace tactus::sim {

// Camera: <tactus:camera>, else that of <gui>, else the first camera sensor, else a view of all bodies. Listener:
// <tactus:listener>, else at the camera. Ambient light and background: <scene>, or the defaults of SDF. `world`:
// the <world>, or the <sdf> of a file that contains only a model.
void read_view(LoadContext& context, const sdf::Element& world);

}  // namespace tactus::sim
