// Pose of the listener: the last known pose of the tool that steers the view; before the first one, that of the
// scene. Pure.
#pragma once

#include <Eigen/Geometry>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "sync/resampling/pose_history.h"

namespace tactus::audio {

// The single source of the listener pose, for blows and for lasting sounds.
class Ear {
 public:
  explicit Ear(sync::OwnClock own) : head_(own) {}

  void set_scene(const scene_t& scene);
  // Accepts the states of all tools, and ignores tools that do not steer the view.
  void push(const tool_state_t& state, sync::HostTime arrival);
  // T_world_listener at an instant.
  Eigen::Isometry3d at(sync::HostTime t);

 private:
  scene_t scene_{};
  int tool_ = -1;  // of the scene; -1: the listener is fixed
  sync::PoseHistory head_;
  Eigen::Isometry3d last_ = Eigen::Isometry3d::Identity();
};

}  // namespace tactus::audio
