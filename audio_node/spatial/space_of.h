// The space that the settings ask for: whose ears, or which loudspeakers.
#pragma once

#include "audio_node/settings.gen.h"
#include "audio_node/spatial/spatialiser.h"

namespace tactus::audio {

// Reads files, and takes a tenth of a second: not in a loop, nor in the callback. Throws std::runtime_error with
// one sentence.
Space space_of(const Settings& settings, double rate_Hz);

}  // namespace tactus::audio
