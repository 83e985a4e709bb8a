// The space that the settings select: ears or loudspeakers.
#pragma once

#include "audio_node/settings.gen.h"
#include "audio_node/spatial/spatialiser.h"

namespace tactus::audio {

// Reads files and takes a tenth of a second: do not call it in a loop or in the callback. Throws
// std::runtime_error with one sentence.
Space space_of(const Settings& settings, double rate_Hz);

}  // namespace tactus::audio
