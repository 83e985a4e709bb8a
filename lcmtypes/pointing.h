// Pointing tools, which neither touch nor feel: a tool with the name of a spot light aims that light, and a tool
// named "head" moves the view, eye and ear.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <tactus/light_def_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <vector>

#include "lcmtypes/vectors.h"

namespace tactus {

// Index of the light that the tool steers; -1: none.
inline int steered_light(const tool_def_t& tool, const std::vector<light_def_t>& lights) {
  const auto light = std::find_if(lights.begin(), lights.end(), [&](const light_def_t& l) {
    return l.kind == light_def_t::SPOT && l.name == tool.name;
  });
  return light == lights.end() ? -1 : static_cast<int>(light - lights.begin());
}

inline bool steers_view(const tool_def_t& tool) { return tool.name == "head"; }

inline bool only_points(const tool_def_t& tool, const std::vector<light_def_t>& lights) {
  return steers_view(tool) || steered_light(tool, lights) >= 0;
}

// Index of the tool that steers the view of a scene; -1: none.
inline int head_of(const scene_t& scene) {
  const auto tool = std::find_if(scene.tools.begin(), scene.tools.end(), steers_view);
  return tool == scene.tools.end() ? -1 : static_cast<int>(tool - scene.tools.begin());
}

// T_world_view of a head with this device pose in the world. The position is that of the device. The direction is
// that of the scene's camera, rotated by the device orientation: with a mouse, which does not rotate, it is the
// camera's direction, and with a level camera along +x it is the orientation of the device.
inline Eigen::Isometry3d view_of(const scene_t& scene, const Eigen::Vector3d& position_m,
                                 const Eigen::Quaterniond& orientation) {
  return Eigen::Translation3d(position_m) * (orientation * to_eigen(scene.camera.orientation));
}

// T_world_listener of such a view: the ear keeps its pose relative to the eye.
inline Eigen::Isometry3d listener_of(const scene_t& scene, const Eigen::Isometry3d& view) {
  return view * to_eigen(scene.camera).inverse() * to_eigen(scene.listener);
}

}  // namespace tactus
