#include "thermal_node/devices/node_config.h"

#include <tactus/tool_def_t.hpp>

namespace tactus::thermal {

NodeConfig resolve_config(const scene_t& scene, const Settings& settings, const std::string& tool_name) {
  NodeConfig config;
  config.settings = settings;
  const std::string& wanted = tool_name.empty() ? config.settings.tool : tool_name;
  std::string names;
  for (int i = 0; i < scene.tool_count; ++i) {
    const tool_def_t& tool = scene.tools[static_cast<std::size_t>(i)];
    names += (names.empty() ? "" : ", ") + tool.name;
    if (config.tool >= 0 || (!wanted.empty() && tool.name != wanted)) continue;
    config.tool = i;
    config.tool_body = tool.body;
  }
  if (config.tool < 0)
    config.problem = scene.tool_count == 0 ? "the scene has no tool; add a <tactus:tool>"
                                           : "the scene has no tool \"" + wanted + "\"; choose one of: " + names;
  return config;
}

}  // namespace tactus::thermal
