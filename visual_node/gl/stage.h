// What the loop draws with: display, renderer, and which pictures are drawn how well.
#pragma once

#include <memory>
#include <string>

#include "sync/degradation/profile.h"
#include "visual_node/egl/display.h"
#include "visual_node/frame/picture_rate.h"
#include "visual_node/frame/quality_control.h"
#include "visual_node/gl/renderer.h"
#include "visual_node/gl/shader_watch.h"
#include "visual_node/scene_view/scene_view.h"

namespace tactus::visual {

class Stage {
 public:
  // Throws std::runtime_error with one sentence when nothing can be drawn on.
  Stage(const Settings& settings, bool window);

  const std::string& description() const { return display_->description(); }
  bool closed() { return display_->closed(); }
  Display& display() { return *display_; }
  const PictureTarget& picture() const { return renderer_->picture(); }
  QualityControl& quality() { return quality_; }

  // A new scene; sample: a picture of it. Takes several ticks, so that no later picture takes longer than others.
  void load(const SceneView& view, const DrawList& sample, const Settings& settings);
  // Whether the tick at `now` shows a new picture, when the output is degraded so.
  bool due(sync::HostTime now, const sync::OutputDef& output) {
    return rate_.due(now, output.frame_rate_Hz, loop_rate_Hz_);
  }
  // One sentence for each thing that could not be drawn as the scene says; asking takes them.
  std::vector<std::string> take_trouble() { return renderer_->take_trouble(); }

  // For how long each picture is held on purpose; 0: for the tick.
  sync::Nanoseconds held() const { return rate_.held(); }

  // The two parts of a picture. Each returns when it has been drawn; then it is presented, which ends with a fence.
  void draw_scene(const DrawList& list, const sync::OutputDef& output);
  void draw_over(const DrawList& list);
  void show();

 private:
  std::unique_ptr<Display> display_;
  std::unique_ptr<Renderer> renderer_;
  QualityControl quality_;
  PictureRate rate_;
  double loop_rate_Hz_;
  std::unique_ptr<ShaderWatch> shaders_;
  bool halves_ = false;  // of the picture, one for each eye of the display
};

}  // namespace tactus::visual
