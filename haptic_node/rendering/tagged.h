// Tags of haptic_node: values of a hand that can be recorded by name, in addition to TOOL_STATE, and can drive
// other renderers (<tactus:map>).
#pragma once

#include <cmath>
#include <tactus/tool_state_t.hpp>
#include <tactus/vec3_t.hpp>

#include "sync/node/tags.h"

namespace tactus::haptic {

inline double norm(const auto& v) { return std::hypot(double(v.x), double(v.y), double(v.z)); }

// state: as last published; outlives the tags.
inline void tag(sync::Tags& tags, const tool_state_t& state) {
  tags.add("force", "N", [&] { return norm(state.force_N); });
  tags.add("force.x", "N", &state.force_N.x);
  tags.add("force.y", "N", &state.force_N.y);
  tags.add("force.z", "N", &state.force_N.z);
  tags.add("torque", "N m", [&] { return norm(state.torque_N_m); });
  tags.add("speed", "m/s", [&] { return norm(state.proxy_velocity_m_s); });
  tags.add("position.x", "m", &state.proxy.position_m.x);
  tags.add("position.y", "m", &state.proxy.position_m.y);
  tags.add("position.z", "m", &state.proxy.position_m.z);
  // Distance between device and proxy.
  tags.add("depth", "m", [&] {
    const vec3_t &d = state.device.position_m, &p = state.proxy.position_m;
    return std::hypot(d.x - p.x, d.y - p.y, d.z - p.z);
  });
  tags.add("energy", "J", &state.energy_J);
  tags.add("injected", "J", &state.injected_J);
}

}  // namespace tactus::haptic
