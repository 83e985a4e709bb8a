// Decodes the meshes of the visible shapes of a scene.
#pragma once

#include "sync/assets/scene_receiver.h"
#include "visual_node/scene_view/scene_view.h"

namespace tactus::visual {

// Meshes of the scene that the receiver holds; meshes that are missing or cannot be decoded are left out.
Meshes meshes_of(const sync::SceneReceiver& scenes);

}  // namespace tactus::visual
