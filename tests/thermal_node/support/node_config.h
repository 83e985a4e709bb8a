// The configuration of a node from a scene and a command line, as the node applies them one after the other.
#pragma once

#include <string>
#include <tactus/scene_t.hpp>
#include <vector>

#include "thermal_node/devices/node_config.h"

namespace tactus::thermal {

// set: name=value. Invalid settings are left out.
inline NodeConfig resolve_config(const scene_t& scene, const std::string& tool_name, const std::vector<std::string>& set) {
  Settings settings;
  sync::apply_settings(settings, setting_fields(), "thermal_node", scene.settings, set);
  return resolve_config(scene, settings, tool_name);
}

// One sentence for each invalid setting.
inline std::vector<std::string> rejected_settings(const scene_t& scene, const std::vector<std::string>& set) {
  Settings settings;
  return sync::apply_settings(settings, setting_fields(), "thermal_node", scene.settings, set);
}

}  // namespace tactus::thermal
