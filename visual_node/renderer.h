// The modality of vision on the renderer host: from the messages of a tick to the picture that is shown and
// recorded.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>
#include <vector>

#include "sync/node/renderer.h"
#include "visual_node/frame/frame_composer.h"
#include "visual_node/frame/frame_lock.h"
#include "visual_node/frame/frame_times.h"
#include "visual_node/frame/wall_sync.h"
#include "visual_node/gl/render_output.h"
#include "visual_node/offline.h"
#include "visual_node/overlay/window_controls.h"
#include "visual_node/video/picture_stream.h"
#include "visual_node/video/recording.h"

namespace tactus::visual {

// Command-line options of visual_node, in addition to those of every node.
struct Options {
  bool window = false, no_video = false, no_pictures = false;
  RecordingOptions recording;
  OfflineOptions log;

  void add_to(sync::Arguments& app);
  // Sets the values that follow from the options of every node. Throws std::runtime_error with one sentence.
  void complete(const std::string& node, const sync::NodeOptions& options);
};

// Opens the output that pictures are drawn on. Throws std::runtime_error with one sentence.
std::unique_ptr<RenderOutput> open_render_output(const Settings& settings, const Options& options);

class NodeRenderer : public sync::SettingsRenderer<Settings> {
 public:
  // render_output: must outlive this object. log: null: renders the messages of the bus.
  NodeRenderer(sync::RendererHost& host, RenderOutput& render_output, const Options& options, Offline* log);

  std::optional<sync::Status> step(sync::HostTime now) override;
  bool closed() override { return render_output_.closed() || controls_.closing(); }
  std::string finish_log(sync::HostTime clock) override { return log_->result(flashed_, reported_ - flashed_, clock); }
  void finish() override;

 private:
  sync::LoadedScene load(const sync::SceneReceiver& scenes, const Settings& settings) override;
  void apply_setting(const Settings& settings, const std::string& name) override;
  void add_tags();
  void start_outputs(const SceneView& view, const Settings& settings);
  void receive(sync::HostTime now);
  void process_messages();
  void recover(sync::HostTime now);
  std::optional<LockedFrame> begin_frame();
  void draw(sync::HostTime now, const std::optional<LockedFrame>& locked);
  void draw_overlays(sync::HostTime latched);
  void present(sync::HostTime latched);
  void record(sync::HostTime now, bool fresh);
  sync::Status status(sync::HostTime now, bool fresh);
  void report_all(const std::vector<std::string>& sentences) const;

  RenderOutput& render_output_;
  Offline* log_;
  sync::ModalityEndpoint::Stream<world_state_t>& world_;
  sync::ModalityEndpoint::Events& events_;
  sync::ModalityEndpoint::Stream<tool_state_t>& tools_;
  FrameComposer composer_;
  FrameLock lock_;
  WallSync walls_;
  Recording recording_;
  PictureStream stream_;
  LiveOverlays overlays_;
  WindowControls controls_;
  LiveQuestions questions_;
  const scene_t* scene_ = nullptr;
  bool loaded_ = false;  // in this tick
  Frame frame_;
  sync::OutputValues output_;  // output operators in force
  sync::HostTime fence_{};
  FrameTimes times_;
  sync::Nanoseconds draw_time_{0}, wait_time_{0};
  std::int64_t slot_ = -1, periods_ = 0;  // of the video; of the loop, ticked and missed
  std::int64_t reported_ = 0, flashed_ = 0;
  std::string last_reported_error_;
};

}  // namespace tactus::visual
