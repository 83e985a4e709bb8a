// Opens files instead of sound cards, for a node that does not follow the clock of the machine.
#pragma once

#include <string>

#include "audio_node/devices/card.h"

namespace tactus::audio {

// Each opened card plays into its own file in that folder: audio.wav, then audio.2.wav. A file gets its final name
// when its card is destroyed. device "null": writes no file. The opened card throws the errors of FileCard.
OpenCard open_files(const std::string& folder, const std::string& device);

}  // namespace tactus::audio
