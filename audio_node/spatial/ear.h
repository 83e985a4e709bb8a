// Where the ear is: where the tool that steers the view was last known to be; while nobody has said so, where the
// scene has it. Pure.
#pragma once

#include <Eigen/Geometry>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "sync/resampling/pose_history.h"

namespace tactus::audio {

// One rule for whatever is heard, for blows and for what sounds on: all of it is where the same ear hears it.
class Ear {
 public:
  explicit Ear(sync::OwnClock own) : head_(own) {}

  void set_scene(const scene_t& scene);
  // Of any tool; those that do not steer the view are not heeded.
  void push(const tool_state_t& state, sync::HostTime arrival);
  // T_world_listener at an instant.
  Eigen::Isometry3d at(sync::HostTime t);

 private:
  scene_t scene_{};
  int tool_ = -1;  // of the scene; -1: the ear stays
  sync::PoseHistory head_;
  Eigen::Isometry3d last_ = Eigen::Isometry3d::Identity();
};

}  // namespace tactus::audio
