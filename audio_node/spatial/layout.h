// Positions of the loudspeakers of a room, for a listener in their centre.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace tactus::audio {

// For each channel the direction of its loudspeaker: unit; x ahead, y to the left, z up. Empty: a silent channel,
// for example of a subwoofer.
using Layout = std::vector<std::optional<Eigen::Vector3d>>;

inline constexpr int kMaxChannels = 32;

// stereo, quad, 5.1, cube, or a CSV file with the columns channel, azimuth_deg (to the left) and elevation_deg
// (up), one row per channel. Reads a file: do not call it in a loop or in the callback. Throws std::runtime_error
// with one sentence.
Layout load_layout(const std::string& name_or_path);
// Parses the text of such a file; `name` appears in errors.
Layout parse_layout(const std::string& csv, const std::string& name);

}  // namespace tactus::audio
