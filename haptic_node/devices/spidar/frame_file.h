// A string frame that is none of the known ones: a JSON file with the fields of StringFrame, and
// "strings": [{"anchor_m": [x, y, z], "knot_m": [x, y, z]}, ...] (knot_m only with eight).
#pragma once

#include <iosfwd>
#include <string>

#include "haptic_node/devices/spidar/string_frame.h"

namespace tactus::haptic {

// Only a regular file of at most 64 kB. Throws std::runtime_error with one sentence when it cannot be read, lacks
// or has an unknown field, or describes a frame that check_frame refuses.
StringFrame read_frame(const std::string& path);
// The same from text; `name` is for the sentence.
StringFrame parse_frame(const std::string& text, const std::string& name);

}  // namespace tactus::haptic
