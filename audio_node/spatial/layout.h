// Where the loudspeakers of a room stand, for a listener in their middle.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace tactus::audio {

// Of each channel the direction of its loudspeaker: unit; x ahead, y to the left, z up. Nothing: a channel that
// stays silent, as that of a subwoofer.
using Layout = std::vector<std::optional<Eigen::Vector3d>>;

inline constexpr int kMaxChannels = 32;

// stereo, quad, 5.1, cube, or a CSV file of the columns channel, azimuth_deg (to the left) and elevation_deg (up),
// with one row for each channel. Reads a file: not in a loop, nor in the callback. Throws std::runtime_error with
// one sentence.
Layout load_layout(const std::string& name_or_path);
// The text of such a file; `name` is what a sentence calls it.
Layout parse_layout(const std::string& csv, const std::string& name);

}  // namespace tactus::audio
