// Reads a custom string frame: a JSON file with the fields of StringFrame, and "strings": [{"anchor_m": [x, y, z],
// "knot_m": [x, y, z]}, ...] (knot_m only with eight).
#pragma once

#include <string>

#include "haptic_node/devices/spidar/string_frame.h"

namespace tactus::haptic {

// Accepts only a regular file of at most 64 kB. Throws std::runtime_error with one sentence when the file cannot
// be read, lacks a field, has an unknown field, or describes a frame that check_frame rejects.
StringFrame read_frame(const std::string& path);
// The same from text; `name` appears in the error.
StringFrame parse_frame(const std::string& text, const std::string& name);

}  // namespace tactus::haptic
