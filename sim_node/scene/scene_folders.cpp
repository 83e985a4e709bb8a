#include "sim_node/scene/scene_folders.h"

#include <cstdlib>
#include <sstream>

#include "sync/text/arguments.h"

namespace tactus::sim {

void add_scene_folder_option(sync::Arguments& app, std::vector<std::string>& folders) {
  app.add_option("--scene-folder", folders,
                 "folder that the scene may read besides its own, once for each; also TACTUS_SCENE_FOLDERS=DIR:DIR")
      .existing_folder()
      .one_value_per_use();
}

std::vector<std::filesystem::path> scene_folders(const std::vector<std::string>& named) {
  std::vector<std::filesystem::path> folders(named.begin(), named.end());
  const char* variable = std::getenv("TACTUS_SCENE_FOLDERS");
  std::istringstream list(variable ? variable : "");
  for (std::string folder; std::getline(list, folder, ':');)
    if (!folder.empty()) folders.emplace_back(folder);
  return folders;
}

}  // namespace tactus::sim
