// The render output of the loop: display, renderer, quality of the pictures and their rate.
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

// Returns null, or throws std::runtime_error with one sentence, when there is no display.
using MakeDisplay = std::function<std::unique_ptr<Display>(const Settings& settings, bool window)>;
std::unique_ptr<Display> make_display(const Settings& settings, bool window);

class RenderOutput {
 public:
  // A device that is lost more than kMaxLosses times within kLossesWithin is not opened again.
  static constexpr std::size_t kMaxLosses = 3;
  static constexpr sync::Nanoseconds kLossesWithin{60'000'000'000};
  // A device that does not finish this many pictures in a row counts as hung.
  static constexpr int kMaxUnfinished = 3;

  // Throws std::runtime_error with one sentence when there is no device to draw on.
  RenderOutput(const Settings& settings, bool window, MakeDisplay make = make_display);
  // An output that draws nothing and takes no time; everything else behaves the same.
  explicit RenderOutput(const Settings& settings);

  bool draws() const { return renderer_ != nullptr; }
  std::string description() const { return display_ ? display_->description() : "draws no pictures"; }
  bool closed() { return display_ && display_->closed(); }
  // Only when draws().
  Display& display() { return *display_; }
  const PictureTarget& picture() const { return renderer_->picture(); }
  QualityControl& quality() { return quality_; }

  // Loads a new scene. sample: a picture of it. Takes many ticks, so that no later picture takes longer than
  // others. meanwhile: called regularly during that time.
  void load(
      const SceneView& view, const DrawList& sample, const Settings& settings,
      const std::function<void()>& meanwhile = [] {});
  // Selects the first quality by the times of pictures of the loaded scene, so that the first second of a world misses no picture
  // while the quality is found. Draws kTimings pictures for each step until one is fast enough; kTimedFor in all at most. clock: of the host.
  static constexpr int kTimings = 5;  // design: the median ignores two outliers
  static constexpr sync::Nanoseconds kTimedFor{1'000'000'000};  // design
  void start_quality(const DrawList& sample, const std::function<sync::HostTime()>& clock, const std::function<void()>& meanwhile = [] {});
  // True when the tick at `now` shows a new picture, at the frame rate of the degraded output.
  bool due(sync::HostTime now, const sync::OutputValues& output) {
    return rate_.due(now, output.value("frame_rate"), loop_rate_Hz_);
  }
  // Call once a tick. Opens the device again when it was lost, hangs, or the display server of its window is gone
  // (then without a window), and loads the scene again. sample: a picture of it. Returns one sentence on the
  // recovery; empty: not needed. Throws std::runtime_error with one sentence when it fails.
  std::string recover(sync::HostTime now, const SceneView* view, const DrawList& sample);

  // Returns and clears one sentence for each thing that could not be drawn as the scene specifies.
  std::vector<std::string> take_warnings() {
    return draws() ? renderer_->take_warnings() : std::vector<std::string>();
  }

  // How long a profile holds each picture; 0: for the tick.
  sync::Nanoseconds held() const { return rate_.held(); }

  // The two parts of a picture; each returns when the part is drawn. show() then presents it, which ends with a
  // fence.
  void draw_scene(const DrawList& list, const sync::OutputValues& output);
  void draw_flashes_and_overlay(const DrawList& list);
  void show();

 private:
  void open();
  void finish() { unfinished_ = renderer_->wait() ? 0 : unfinished_ + 1; }

  Settings settings_;
  bool window_;
  MakeDisplay make_;
  int unfinished_ = 0;                 // unfinished pictures in a row
  std::deque<sync::HostTime> losses_;  // times of the newest losses
  std::unique_ptr<Display> display_;
  std::unique_ptr<Renderer> renderer_;
  QualityControl quality_;
  PictureRate rate_;
  double loop_rate_Hz_;
  std::unique_ptr<ShaderWatch> shaders_;
  bool halves_ = false;  // the picture has two halves, one for each eye of the display
};

}  // namespace tactus::visual
