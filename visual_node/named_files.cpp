#include "visual_node/named_files.h"

#include <filesystem>
#include <stdexcept>

#include "visual_node/lens/wall.h"

namespace tactus::visual {

void check_named_files(const Settings& settings) {
  if (settings.room != "none") load_room(settings.room).chosen_wall(settings.room, settings.wall);
  std::error_code ignored;
  if (!settings.shader_folder.empty() && !std::filesystem::is_directory(settings.shader_folder, ignored))
    throw std::runtime_error("the folder of shaders " + settings.shader_folder + " does not exist; give the path of a folder to the setting shader_folder");
}

}  // namespace tactus::visual
