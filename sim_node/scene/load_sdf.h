// Reads a world from an SDFormat file (1.4 to 1.9) and our own <tactus:...> elements in it; docs/scene_format.md says
// which elements count.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim_node/model/world_def.h"

namespace tactus::sim {

// Adds one sentence per element that is not supported, or that was repaired, to `warnings`: "FILE:LINE: XML path ...".
// Throws std::runtime_error with one sentence, "FILE:LINE: what is wrong and what to do", when the file is wrong.
WorldDef load_sdf(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace tactus::sim
