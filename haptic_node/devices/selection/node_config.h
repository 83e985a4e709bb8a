// What a node renders of a scene: which tool, with which settings. Pure.
#pragma once

#include <string>
#include <tactus/scene_t.hpp>
#include <vector>

#include "haptic_node/settings.gen.h"

namespace tactus::haptic {

struct NodeConfig {
  int tool = -1;        // index in scene.tools; -1: none, then `problem` says why
  std::string problem;  // one sentence
  Settings settings;
  std::vector<std::string> refused;  // one sentence per setting that does not fit
};

// tool_name: empty takes the first tool.
NodeConfig resolve_config(const scene_t& scene, const Settings& settings, const std::string& tool_name);
// The same with the settings of the scene and of the command line. set: "name=value", which override the scene.
NodeConfig resolve_config(const scene_t& scene, const std::string& tool_name, const std::vector<std::string>& set);

// What the hand is protected by, one line for the log.
std::string limits_sentence(const Settings& settings);

}  // namespace tactus::haptic
