// Settings and tool of this node from the scene and the command line. Pure.
#pragma once

#include <string>
#include <tactus/scene_t.hpp>

#include "thermal_node/settings.gen.h"

namespace tactus::thermal {

struct NodeConfig {
  Settings settings;
  int tool = -1;  // index in scene.tools; -1: none
  int tool_body = -1;
  std::string problem;               // reason why there is no tool, one sentence; otherwise empty
};

// tool_name: from the command line; empty: the setting, otherwise the first tool of the scene.
NodeConfig resolve_config(const scene_t& scene, const Settings& settings, const std::string& tool_name);

}  // namespace tactus::thermal
