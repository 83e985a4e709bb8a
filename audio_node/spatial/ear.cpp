#include "audio_node/spatial/ear.h"

#include "lcmtypes/pointing.h"

namespace tactus::audio {

void Ear::set_scene(const scene_t& scene) {
  scene_ = scene;
  tool_ = head_of(scene);
  head_.clear();
  last_ = to_eigen(scene.listener);
}

void Ear::push(const tool_state_t& state, sync::HostTime arrival) {
  if (tool_ >= 0 && state.tool == tool_) head_.push(state, arrival);
}

Eigen::Isometry3d Ear::at(sync::HostTime t) {
  if (const auto head = head_.at(t); tool_ >= 0 && head.status != sync::SampleStatus::kNone)
    last_ = listener_of(scene_, view_of(scene_, head.value.position, head.value.orientation));
  return last_;
}

}  // namespace tactus::audio
