// The files and folders that settings name, for --check.
#pragma once

#include "audio_node/settings.gen.h"

namespace tactus::audio {

// Reads the files that differ from the defaults. Throws std::runtime_error with one sentence about the first one that cannot be
// used.
void check_named_files(const Settings& settings);

}  // namespace tactus::audio
