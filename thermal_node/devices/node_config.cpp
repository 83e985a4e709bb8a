#include "thermal_node/devices/node_config.h"

#include <tactus/tool_def_t.hpp>
#include <utility>

namespace tactus::thermal {

NodeConfig resolve_config(const scene_t& scene, const std::string& tool_name, const std::vector<std::string>& set) {
  Settings settings;
  std::vector<std::string> refused =
      sync::apply_settings(settings, setting_fields(), "thermal_node", scene.settings, set);
  NodeConfig choice = resolve_config(scene, settings, tool_name);
  choice.refused = std::move(refused);
  return choice;
}

NodeConfig resolve_config(const scene_t& scene, const Settings& settings, const std::string& tool_name) {
  NodeConfig choice;
  choice.settings = settings;
  const std::string& wanted = tool_name.empty() ? choice.settings.tool : tool_name;
  std::string names;
  for (int i = 0; i < scene.tool_count; ++i) {
    const tool_def_t& tool = scene.tools[static_cast<std::size_t>(i)];
    names += (names.empty() ? "" : ", ") + tool.name;
    if (choice.tool >= 0 || (!wanted.empty() && tool.name != wanted)) continue;
    choice.tool = i;
    choice.tool_body = tool.body;
  }
  if (choice.tool < 0)
    choice.problem = scene.tool_count == 0 ? "the scene has no tool, so there is nothing to feel with"
                                           : "the scene has no tool \"" + wanted + "\"; choose one of: " + names;
  return choice;
}

}  // namespace tactus::thermal
