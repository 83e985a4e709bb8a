// The meshes that the visible shapes of a scene refer to.
#pragma once

#include "sync/assets/scene_exchange.h"
#include "visual_node/scene_view/scene_view.h"

namespace tactus::visual {

// Of the scene that the receiver holds; those that are not there or not decodable are left out.
Meshes meshes_of(const sync::SceneReceiver& scenes);

}  // namespace tactus::visual
