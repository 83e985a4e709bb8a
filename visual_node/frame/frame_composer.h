// Composes the picture of one instant from all received messages; the loop uses only this object. Pure.
//
// A frame shows the world at the time of its presentation: the tick plus the drawing time. Its events are latched
// late: after all surfaces are drawn, just before the flashes are drawn.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tactus/contact_events_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>
#include <vector>

#include "sync/resampling/body_history.h"
#include "sync/resampling/contact_stream.h"
#include "sync/resampling/pose_history.h"
#include "visual_node/frame/display_gain.h"
#include "visual_node/frame/event_ledger.h"
#include "visual_node/frame/locked_frame.h"
#include "visual_node/frame/motion_marker.h"
#include "visual_node/frame/render_time.h"
#include "visual_node/frame/sample_status_counts.h"
#include "visual_node/frame/tool_history.h"
#include "visual_node/scene_view/flashes.h"
#include "visual_node/scene_view/scene_view.h"

namespace tactus::visual {

struct Frame {
  DrawList list;
  sync::SampleStatus status = sync::SampleStatus::kNone;            // how the poses of the bodies were obtained
  std::int8_t state = node_health_t::WAITING;  // state of the node, for its health message
  std::string note;
  std::int64_t number = 0;
  std::vector<PoseSample> samples;  // newest TOOL_STATE of each tool in the frame
  std::vector<Eigen::Vector3d> tool_forces_N;  // on the hand of each tool, as drawn; of a tool without report: 0
  std::optional<sync::SimTime> instant;  // shown instant of the world
  std::vector<ToolPose> tools;           // as drawn
};

class FrameComposer {
 public:
  // Assumed time from latch to fence before the first frame: typical for a software renderer.
  static constexpr sync::Nanoseconds kInitialFlashTime{1'000'000};

  // own: messages of another clock are read through its map, those of another run by arrival. late: the outcome
  // of an event that could not be shown in time. events: those of the node; null: its own, from push().
  FrameComposer(sync::OwnClock own, const Settings& settings, sync::LateRule late = sync::LateRule::kShowNewest,
                sync::EventInbox* events = nullptr);

  void set_schedule(Schedule schedule) { ledger_.set_schedule(std::move(schedule)); }
  // Sets the assumed times from tick to fence and from latch to fence until frames are measured. 0 for a log,
  // where drawing takes no time.
  void set_expected_times(sync::Nanoseconds frame, sync::Nanoseconds flashes) {
    render_time_ = RenderTime(frame), latch_time_ = RenderTime(flashes);
  }
  void push(const world_state_t& m, sync::HostTime arrival) { bodies_.push(m, arrival); }
  void push(const contact_events_t& m, sync::HostTime arrival) { contacts_.push(m, arrival); }
  void push(const tool_state_t& m, sync::HostTime arrival) {
    if (may_show(m.tool)) tools_[m.tool].reports.push(m, arrival);
    if (m.tool == head_tool_) head_.push(m, arrival);
  }
  // Loads a new scene and returns its view, which supplies the geometries to the renderer. Bodies and events are
  // kept.
  const SceneView& load(const scene_t& scene, const Meshes& meshes, const Settings& settings,
                        const HeightMaps& height_maps = {}, LookFiles look_files = {});

  // Null before the first scene.
  const SceneView* view() const { return view_ ? &*view_ : nullptr; }
  // Applies the settings that each frame reads.
  void change(const Settings& settings) {
    settings_.exposure = settings.exposure;
    settings_.display_gain = settings.display_gain;
    settings_.text_size = settings.text_size;
    settings_.text_contrast = settings.text_contrast;
  }
  // Sets the colours of the scene's bodies, as SceneView::tint.
  void tint(std::vector<Eigen::Vector4f> bodies) {
    if (view_) view_->tint(std::move(bodies));
  }

  // Draws the list of the frame that begins now, with this number. delay: age of the shown world at presentation.
  // newest_arrival: of any message before degradation, so that a gap made by a profile is not taken for a loss.
  // view_delay: the part of `delay` that a profile adds. Eye and tools are where they are when the frame is presented: a
  // profile delays them with the world, a playout policy does not.
  Frame frame(sync::HostTime now, std::int64_t number, sync::Nanoseconds delay = sync::Nanoseconds(0),
              sync::HostTime newest_arrival = sync::HostTime{},
              sync::Nanoseconds view_delay = sync::Nanoseconds(0));
  // Draws the frame that all walls of the room agree on, with its own number, instant and head.
  Frame frame(sync::HostTime now, const LockedFrame& locked, sync::HostTime newest_arrival,
              sync::Nanoseconds view_delay = sync::Nanoseconds(0));
  // Call when the surfaces of that frame are drawn: adds everything above them, with the events that arrived
  // until now. held: how long a profile holds each picture; the picture shows the events up to its instant. 0:
  // one picture a tick.
  void latch(Frame& frame, sync::HostTime now, sync::Nanoseconds delay = sync::Nanoseconds(0),
             sync::Nanoseconds held = sync::Nanoseconds(0));
  // Call when that frame was presented, at `fence`. Returns the reports of the events that it showed first or
  // dropped.
  std::vector<presentation_t> presented(sync::HostTime fence);

  // Counts every moving body in every frame.
  const SampleStatusCounts& poses() const { return poses_; }

 private:
  struct DrawnTool {
    ToolHistory reports;
    DisplayGain display = {};
  };
  // delay, view_delay: as of frame().
  struct Delays {
    sync::Nanoseconds delay, view_delay;
  };
  static constexpr int kMaxTools = 64;  // before a scene; more come only from corrupt messages
  // False for a tool that the scene does not have: its reports are not stored.
  bool may_show(int tool) const { return tool >= 0 && tool < (scene_ ? static_cast<int>(scene_->tools.size()) : kMaxTools); }
  void draw(Frame& frame, sync::HostTime now, const Delays& delays, std::optional<sync::SimTime> instant,
            const sync::Sample<sync::BodyPose>& head, sync::HostTime newest_arrival);
  void add_due_flashes(sync::HostTime t, sync::Nanoseconds delay, sync::Nanoseconds held);
  sync::HostTime next_presentation(sync::HostTime t) const;
  void assess_state(Frame& frame, sync::HostTime now, sync::HostTime newest_arrival);
  std::vector<Eigen::Isometry3d> body_poses(std::optional<sync::SimTime> t);
  // presented: the host time whose tools are shown, at most now.
  void add_tools(Frame& frame, sync::HostTime presented, sync::HostTime now);
  static ToolPose tool_pose(const tool_state_t& state, std::optional<sync::SimTime> t);
  std::optional<Eigen::Isometry3d> view_of_head(const sync::Sample<sync::BodyPose>& head, Frame& frame) const;

  Settings settings_;
  sync::ContactStream contacts_;
  sync::BodyHistory bodies_;
  std::map<int, DrawnTool> tools_;
  sync::HostTime tools_drawn_{};
  sync::PoseHistory head_;
  int head_tool_ = -1;  // index of the tool that the view follows; -1: none
  std::optional<scene_t> scene_;
  std::optional<SceneView> view_;
  Flashes flashes_;
  EventLedger ledger_;
  RenderTime render_time_, latch_time_{kInitialFlashTime};  // times from tick and from latch to the fence
  sync::HostTime tick_{}, latched_{};
  std::optional<sync::HostTime> due_;  // of the frame in progress, when the walls agree on it
  std::optional<sync::HostTime> stale_since_;
  SampleStatusCounts poses_;
};

}  // namespace tactus::visual
