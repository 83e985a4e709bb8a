#include "haptic_node/devices/selection/node_config.h"

#include <sstream>

namespace tactus::haptic {

NodeConfig resolve_config(const scene_t& scene, const Settings& settings, const std::string& tool_name) {
  NodeConfig c;
  c.settings = settings;
  for (std::size_t i = 0; i < scene.tools.size() && c.tool < 0; ++i)
    if (tool_name.empty() || scene.tools[i].name == tool_name) c.tool = static_cast<int>(i);
  if (c.tool < 0)
    c.problem = tool_name.empty() ? "the scene has no tool; add a <tactus:tool>"
                                  : "the scene has no tool \"" + tool_name + "\"; give --tool another name";
  return c;
}

std::string limits_sentence(const Settings& s) {
  std::ostringstream out;
  out << "force at most " << s.force_limit_N << " N, rising by at most " << s.slew_limit_N_s / 1000
      << " N/ms, torque at most " << s.torque_limit_Nm << " N m, rising by at most "
      << s.torque_slew_limit_Nm_s / 1000 << " N m/ms, energy to the hand at most " << s.energy_limit_J
      << " J plus " << s.power_limit_W << " W, within " << s.workspace_m
      << " m of the initial position of the device; zero within " << (s.stale_after_s + s.fade_s) * 1000
      << " ms without a touch model";
  return out.str();
}

}  // namespace tactus::haptic
