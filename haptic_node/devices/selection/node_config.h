// Selection of the tool and the settings of a node from a scene. Pure.
#pragma once

#include <string>
#include <tactus/scene_t.hpp>

#include "haptic_node/settings.gen.h"

namespace tactus::haptic {

struct NodeConfig {
  int tool = -1;        // index in scene.tools; -1: none, see `problem`
  std::string problem;  // one sentence
  Settings settings;
};

// tool_name: empty selects the first tool.
NodeConfig resolve_config(const scene_t& scene, const Settings& settings, const std::string& tool_name);
// The safety limits in one line for the log.
std::string limits_sentence(const Settings& settings);

}  // namespace tactus::haptic
