// What the loop draws with: display, renderer, and which pictures are drawn how well.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "sync/degradation/profile.h"
#include "visual_node/devices/display.h"
#include "visual_node/frame/picture_rate.h"
#include "visual_node/frame/quality_control.h"
#include "visual_node/gl/renderer.h"
#include "visual_node/gl/shader_watch.h"
#include "visual_node/scene_view/scene_view.h"

namespace tactus::visual {

// Null, or a std::runtime_error with one sentence, is no display.
using MakeDisplay = std::function<std::unique_ptr<Display>(const Settings& settings, bool window)>;
std::unique_ptr<Display> make_display(const Settings& settings, bool window);

class RenderOutput {
 public:
  // What is lost more often than so many times in so long is given up.
  static constexpr std::size_t kMaxLosses = 3;
  static constexpr sync::Nanoseconds kLossesWithin{60'000'000'000};
  // A device that does not finish so many pictures in a row hangs.
  static constexpr int kMaxUnfinished = 3;

  // Throws std::runtime_error with one sentence when nothing can be drawn on.
  RenderOutput(const Settings& settings, bool window, MakeDisplay make = make_display);
  // One that draws nothing, in no time: all else is as if it did.
  explicit RenderOutput(const Settings& settings);

  bool draws() const { return renderer_ != nullptr; }
  std::string description() const { return display_ ? display_->description() : "draws no pictures"; }
  bool closed() { return display_ && display_->closed(); }
  // Of one that draws.
  Display& display() { return *display_; }
  const PictureTarget& picture() const { return renderer_->picture(); }
  QualityControl& quality() { return quality_; }

  // A new scene; sample: a picture of it. Takes many ticks, so that no later picture takes longer than others;
  // meanwhile: is called every now and then.
  void load(
      const SceneView& view, const DrawList& sample, const Settings& settings,
      const std::function<void()>& meanwhile = [] {});
  // Whether the tick at `now` shows a new picture, when the output is degraded so.
  bool due(sync::HostTime now, const sync::OutputDef& output) {
    return rate_.due(now, output.frame_rate_Hz, loop_rate_Hz_);
  }
  // Once a tick. A device that has forgotten all, hangs, or whose window's display server is gone is opened again,
  // without the window then, and what was loaded is loaded again; sample: a picture of it. One sentence on what
  // was done; empty: there was no need. Throws std::runtime_error with one sentence when it cannot.
  std::string recover(sync::HostTime now, const SceneView* view, const DrawList& sample);

  // One sentence for each thing that could not be drawn as the scene says; asking takes them.
  std::vector<std::string> take_trouble() { return draws() ? renderer_->take_trouble() : std::vector<std::string>(); }

  // For how long each picture is held on purpose; 0: for the tick.
  sync::Nanoseconds held() const { return rate_.held(); }

  // The two parts of a picture. Each returns when it has been drawn; then it is presented, which ends with a
  // fence.
  void draw_scene(const DrawList& list, const sync::OutputDef& output);
  void draw_over(const DrawList& list);
  void show();

 private:
  void open();
  void finish() { unfinished_ = renderer_->wait() ? 0 : unfinished_ + 1; }

  Settings settings_;
  bool window_;
  MakeDisplay make_;
  int unfinished_ = 0;                 // pictures in a row
  std::deque<sync::HostTime> losses_;  // the newest
  std::unique_ptr<Display> display_;
  std::unique_ptr<Renderer> renderer_;
  QualityControl quality_;
  PictureRate rate_;
  double loop_rate_Hz_;
  std::unique_ptr<ShaderWatch> shaders_;
  bool halves_ = false;  // of the picture, one for each eye of the display
};

}  // namespace tactus::visual
