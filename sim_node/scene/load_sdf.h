// Loads a world from an SDFormat file (1.4 to 1.9) with <tactus:...> elements; docs/scene_format.md lists the
// supported elements.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim_node/model/world_def.h"

namespace tactus::sim {

// Adds one sentence per unsupported or repaired element to `warnings`: "FILE:LINE: XML path ...". Throws
// std::runtime_error with one sentence, "FILE:LINE: problem: remedy", when the file is invalid.
WorldDef load_sdf(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace tactus::sim
