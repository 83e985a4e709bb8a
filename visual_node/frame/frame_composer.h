// Composes the picture of one instant from everything that has arrived: the one object behind the loop. Pure.
//
// A frame shows the world at the instant at which it will be presented: the tick plus the time that drawing takes.
// Its events are latched late: when all surfaces have been drawn, just before the flashes are.
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
#include "visual_node/frame/agreed_frame.h"
#include "visual_node/frame/display_gain.h"
#include "visual_node/frame/event_ledger.h"
#include "visual_node/frame/how_count.h"
#include "visual_node/frame/motion_marker.h"
#include "visual_node/frame/render_time.h"
#include "visual_node/scene_view/flashes.h"
#include "visual_node/scene_view/scene_view.h"

namespace tactus::visual {

struct Frame {
  DrawList list;
  sync::SampleStatus status = sync::SampleStatus::kNone;            // how the poses of the bodies were obtained
  std::int8_t state = node_health_t::WAITING;  // of the node, for its health
  std::string note;
  std::int64_t number = 0;
  std::vector<PoseSample> samples;  // newest report of each tool that it shows
  std::optional<sync::SimTime> instant;  // of the world that it shows
  std::vector<ToolPose> tools;           // as they are drawn
};

class FrameComposer {
 public:
  // From latch to fence, before the first frame: a software renderer's typical time.
  static constexpr sync::Nanoseconds kFlashesTake{1'000'000};

  // own: messages of another clock are read through its map; those of another run by arrival.
  // late: what becomes of an event that could not be shown in time.
  FrameComposer(sync::OwnClock own, const Settings& settings, sync::Late late = sync::Late::kShowNewest);

  void set_schedule(Schedule schedule) { ledger_.set_schedule(std::move(schedule)); }
  // Until frames are measured: so long from tick to fence and from latch to fence. 0: of a log, where drawing
  // takes no time.
  void foresee(sync::Nanoseconds frame, sync::Nanoseconds flashes) {
    render_time_ = RenderTime(frame), latch_time_ = RenderTime(flashes);
  }
  void push(const world_state_t& m, sync::HostTime arrival) { bodies_.push(m, arrival); }
  void push(const contact_events_t& m, sync::HostTime arrival) { contacts_.push(m, arrival); }
  void push(const tool_state_t& m, sync::HostTime arrival) {
    ToolArrival& tool = tools_[m.tool];
    tool.state = m, tool.arrival = arrival;
    if (m.tool == head_tool_) head_.push(m, arrival);
  }
  // A new scene; its view gives the geometries to the renderer. What was known of bodies and events stays.
  const SceneView& load(const scene_t& scene, const Meshes& meshes, const Settings& settings,
                        const HeightMaps& height_maps = {}, LookFiles look_files = {});

  // Null before the first scene.
  const SceneView* view() const { return view_ ? &*view_ : nullptr; }
  // Of the settings, those that are looked at in each frame.
  void change(const Settings& settings) {
    settings_.exposure = settings.exposure;
    settings_.display_gain = settings.display_gain;
  }
  // Colours of the scene's bodies from now on, as SceneView::tint.
  void tint(std::vector<Eigen::Vector4f> bodies) {
    if (view_) view_->tint(std::move(bodies));
  }

  // The frame that begins now, number `number` of all. delay: what it shows happened so long before it is seen;
  // newest_arrival: of any message, raw: a gap in what is let through is then commanded and no loss.
  // view_delay: of that, what a profile adds. The eye is where it is when the frame is presented: no policy moves
  // it.
  Frame frame(sync::HostTime now, std::int64_t number, sync::Nanoseconds delay = sync::Nanoseconds(0),
              sync::HostTime newest_arrival = sync::HostTime{},
              sync::Nanoseconds view_delay = sync::Nanoseconds(0));
  // The frame that all walls of the room agree on, with its own number, instant and head.
  Frame frame(sync::HostTime now, const AgreedFrame& agreed, sync::HostTime newest_arrival);
  // The surfaces of that frame are drawn, now: adds what lies over them, with the events that arrived until now.
  // held: each picture stays for so long because a profile wants few; it shows the events up to its instant. 0: a
  // picture in every tick.
  void latch(Frame& frame, sync::HostTime now, sync::Nanoseconds delay = sync::Nanoseconds(0),
             sync::Nanoseconds held = sync::Nanoseconds(0));
  // That frame was presented at `fence`: reports of the events that it showed first or dropped.
  std::vector<presentation_t> presented(sync::HostTime fence);

  // Of every body that moves, in every frame.
  const HowCount& poses() const { return poses_; }

 private:
  struct ToolArrival {
    tool_state_t state;
    sync::HostTime arrival;
    DisplayGain display = {};
  };
  void draw(Frame& frame, sync::HostTime now, sync::Nanoseconds delay, std::optional<sync::SimTime> instant,
            const sync::Sample<sync::BodyPose>& head, sync::HostTime newest_arrival);
  void flash_due(sync::HostTime t, sync::Nanoseconds delay, sync::Nanoseconds held);
  sync::HostTime presented_next(sync::HostTime t) const;
  void judge(Frame& frame, sync::HostTime now, sync::HostTime newest_arrival);
  std::vector<Eigen::Isometry3d> body_poses(std::optional<sync::SimTime> t);
  std::vector<PoseSample> newest_samples(sync::HostTime now) const;
  std::vector<ToolPose> tool_poses(std::optional<sync::SimTime> t, sync::HostTime now);
  std::optional<Eigen::Isometry3d> view_of_head(const sync::Sample<sync::BodyPose>& head, Frame& frame) const;

  Settings settings_;
  sync::ContactStream contacts_;
  sync::BodyHistory bodies_;
  std::map<int, ToolArrival> tools_;
  sync::HostTime tools_drawn_{};
  sync::PoseHistory head_;
  int head_tool_ = -1;  // of the scene, which the view follows; -1: none
  std::optional<scene_t> scene_;
  std::optional<SceneView> view_;
  Flashes flashes_;
  EventLedger ledger_;
  RenderTime render_time_, latch_time_{kFlashesTake};  // from tick and latch to the fence
  sync::HostTime tick_{}, latched_{};
  std::optional<sync::HostTime> due_;  // of the frame being drawn, when the walls agree on it
  std::optional<sync::HostTime> stale_since_;
  HowCount poses_;
};

}  // namespace tactus::visual
