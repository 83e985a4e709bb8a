// The pictures that lie on the surfaces of a scene, its reliefs and friction maps, for a thread that reads them:
// no loop may, since that can take as long as a second. Pure.
#pragma once

#include <cstdint>
#include <map>

#include "sync/assets/scene_exchange.h"

namespace tactus::sync {

using Pictures = std::map<std::int64_t, Bytes>;  // by content hash

// The pictures that the materials of the receiver's scene name, as far as they were sent. It copies them.
Pictures pictures_of(const SceneReceiver& scenes);

}  // namespace tactus::sync
