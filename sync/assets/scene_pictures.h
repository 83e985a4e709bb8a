// The pictures on the surfaces of a scene, its height maps and friction maps, for a thread that decodes them: decoding can
// take a second, too long for a loop. Pure.
#pragma once

#include <cstdint>
#include <map>

#include "sync/assets/scene_receiver.h"

namespace tactus::sync {

using Pictures = std::map<std::int64_t, Bytes>;  // by content hash

// The pictures that the materials of the receiver's scene name, as far as they have arrived. It copies them.
Pictures pictures_of(const SceneReceiver& scenes);

}  // namespace tactus::sync
