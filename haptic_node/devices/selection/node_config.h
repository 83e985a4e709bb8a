// Selection of the tool and the settings of a node from a scene. Pure.
#pragma once

#include <string>
#include <tactus/scene_t.hpp>
#include <vector>

#include "haptic_node/settings.gen.h"

namespace tactus::haptic {

struct NodeConfig {
  int tool = -1;        // index in scene.tools; -1: none, see `problem`
  std::string problem;  // one sentence
  Settings settings;
  std::vector<std::string> rejected;  // one sentence per invalid setting
};

// tool_name: empty selects the first tool.
NodeConfig resolve_config(const scene_t& scene, const Settings& settings, const std::string& tool_name);
// The same with the settings of the scene and of the command line. set: "name=value", which override the scene.
NodeConfig resolve_config(const scene_t& scene, const std::string& tool_name, const std::vector<std::string>& set);

// The safety limits in one line for the log.
std::string limits_sentence(const Settings& settings);

}  // namespace tactus::haptic
