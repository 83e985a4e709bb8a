#include "sim_node/scene/scene_folders.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "sync/text/arguments.h"

namespace tactus::sim {
namespace {

// The folders in an environment variable, which a colon separates.
std::vector<std::filesystem::path> folders_of(const char* variable) {
  const char* value = std::getenv(variable);
  std::istringstream list(value ? value : "");
  std::vector<std::filesystem::path> folders;
  for (std::string folder; std::getline(list, folder, ':');)
    if (!folder.empty()) folders.emplace_back(folder);
  return folders;
}

}  // namespace

void add_scene_folder_option(sync::Arguments& app, std::vector<std::string>& folders) {
  app.add_option("--scene-folder", folders,
                 "folder that the scene may read besides its own, once for each; also TACTUS_SCENE_FOLDERS=DIR:DIR")
      .existing_folder()
      .one_value_per_use();
}

std::vector<std::filesystem::path> scene_folders(const std::vector<std::string>& named) {
  std::vector<std::filesystem::path> folders(named.begin(), named.end());
  const auto add = [&](const std::filesystem::path& folder) {
    if (std::find(folders.begin(), folders.end(), folder) == folders.end()) folders.push_back(folder);
  };
  for (const auto& folder : folders_of("TACTUS_SCENE_FOLDERS")) add(folder);
  // The paths of a Gazebo installation; they may name folders that are not there.
  std::error_code error;
  for (const auto& folder : folders_of("GZ_SIM_RESOURCE_PATH"))
    if (std::filesystem::is_directory(folder, error)) add(folder);
  return folders;
}

}  // namespace tactus::sim
