// Loads a world from an SDFormat file (1.4 to 1.12) with <tactus:...> elements; docs/scene_format.md lists the
// supported elements.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim_node/model/world_def.h"

namespace tactus::sim {

struct LoadOptions {
  // Folders that the user named (scene_folders.h); the scene may read files below them and below its own folder, and no others.
  std::vector<std::filesystem::path> folders = {};
  // Reads geometry files in a confined process (meshes/confined_reader.h); false: in this one, for tests.
  bool confined = true;
};

// Adds one sentence per unsupported or repaired element to `warnings`: "FILE:LINE: XML path ...". Throws
// std::runtime_error with one sentence, "FILE:LINE: problem: remedy", when the file is invalid.
WorldDef load_sdf(const std::filesystem::path& file, std::vector<std::string>& warnings, const LoadOptions& options = {});

}  // namespace tactus::sim
