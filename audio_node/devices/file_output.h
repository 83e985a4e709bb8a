// Files in place of sound cards, for a node that does not live by the machine's clock.
#pragma once

#include <string>

#include "audio_node/devices/card.h"

namespace tactus::audio {

// Each card that it opens plays into a file of its own in that folder: audio.wav, then audio.2.wav. A file has its name once
// the card has gone. device "null": nothing is kept. What it opens throws what FileCard does.
OpenCard open_files(const std::string& folder, const std::string& device);

}  // namespace tactus::audio
