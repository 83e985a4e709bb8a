// The folders that the user allows a scene to read besides its own, the same in every program that reads scenes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::sync {
class Arguments;
}

namespace tactus::sim {

// Adds the option --scene-folder DIR, once for each folder.
void add_scene_folder_option(sync::Arguments& app, std::vector<std::string>& folders);

// The named folders, then those of the environment variable TACTUS_SCENE_FOLDERS, then those of GZ_SIM_RESOURCE_PATH that
// exist; a colon separates them. Each is there once.
std::vector<std::filesystem::path> scene_folders(const std::vector<std::string>& named);

}  // namespace tactus::sim
