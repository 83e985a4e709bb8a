#include "visual_node/frame/frame_composer.h"

#include <algorithm>
#include <tactus/body_def_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <utility>

#include "lcmtypes/pointing.h"
#include "lcmtypes/vectors.h"
#include "visual_node/frame/marker.h"
#include "visual_node/frame/text.h"

namespace tactus::visual {
namespace {

// A tool without a message for this long is drawn where the simulation holds it: after the death of haptic_node the
// hand has no place.
constexpr sync::Nanoseconds kToolStaleAfter{200'000'000};
// The pose of a tool is extrapolated by at most a frame: a hand turns around faster than a ball.
constexpr sync::Nanoseconds kMaxToolExtrapolation{17'000'000};
// Background without a scene: nearly black, so that text on it is readable.
const Eigen::Vector3f kNoScene{0.01f, 0.012f, 0.016f};
// Position and size of the status word, pixels.
constexpr float kTextAt_px = 8, kTextSize_px = 2;

Eigen::Isometry3d to_isometry(const sync::BodyPose& p) { return Eigen::Translation3d(p.position) * p.orientation; }

const char* word(const Frame& frame) {
  switch (frame.state) {
    case node_health_t::WAITING:
    case node_health_t::READY: return "WAITING";
    case node_health_t::INPUT_LOST: return "LOST";
    case node_health_t::STALE: return frame.status == sync::SampleStatus::kHeld ? "HELD" : "STALE";
    default: return "";
  }
}

}  // namespace

FrameComposer::FrameComposer(sync::OwnClock own, const Settings& settings, sync::LateRule late, sync::EventInbox* events)
    : settings_(settings), contacts_(events ? sync::ContactStream(*events) : sync::ContactStream(own)), bodies_(own), head_(own), flashes_(settings), ledger_(settings, late) {}

const SceneView& FrameComposer::load(const scene_t& scene, const Meshes& meshes, const Settings& settings,
                                     const HeightMaps& height_maps, LookFiles look_files) {
  settings_ = settings;
  scene_ = scene;
  std::erase_if(tools_, [this](const auto& tool) { return !may_show(tool.first); });
  head_tool_ = head_of(scene);
  head_.clear();
  view_.emplace(scene, meshes, settings, height_maps, std::move(look_files));
  flashes_ = Flashes(settings);
  ledger_.set(settings);
  return *view_;
}

Frame FrameComposer::frame(sync::HostTime now, std::int64_t number, sync::Nanoseconds delay,
                           sync::HostTime newest_arrival, sync::Nanoseconds view_delay) {
  due_.reset();
  const sync::HostTime t = now + render_time_.expected();
  const auto map = bodies_.map(now);
  head_.extend_history(view_delay);
  Frame frame;
  frame.number = number;
  draw(frame, now, {delay, view_delay}, map ? std::optional(map->to_sim(t - delay)) : std::nullopt, head_.at(t - view_delay),
       newest_arrival);
  return frame;
}

Frame FrameComposer::frame(sync::HostTime now, const LockedFrame& locked, sync::HostTime newest_arrival,
                           sync::Nanoseconds view_delay) {
  due_ = locked.due_host_time;
  Frame frame;
  frame.number = locked.number;
  draw(frame, now, {locked.delay, view_delay}, locked.sim_time, locked.head, newest_arrival);
  for (PoseSample& sample : frame.samples)
    if (sample.tool == head_tool_ && locked.head_ns >= 0) sample.seq = locked.head_seq;
  return frame;
}

void FrameComposer::draw(Frame& frame, sync::HostTime now, const Delays& delays,
                         std::optional<sync::SimTime> instant, const sync::Sample<sync::BodyPose>& head,
                         sync::HostTime newest_arrival) {
  tick_ = now;
  bodies_.extend_history(delays.delay);
  for (auto& [tool, drawn] : tools_) drawn.reports.extend_history(delays.view_delay);
  frame.instant = instant;
  if (instant) frame.status = bodies_.status(*instant);
  assess_state(frame, now, newest_arrival);
  const sync::HostTime shown = due_.value_or(now + render_time_.expected()) - delays.view_delay;
  add_tools(frame, std::min(shown, now), now);
  if (view_) {
    frame.list = view_->draw(body_poses(instant), frame.tools, view_of_head(head, frame));
    frame.list.lighting.exposure = static_cast<float>(settings_.exposure);
  } else {
    frame.list.lighting.background = kNoScene;
  }
}

void FrameComposer::latch(Frame& frame, sync::HostTime now, sync::Nanoseconds delay, sync::Nanoseconds held) {
  latched_ = now;
  const sync::HostTime t = due_.value_or(now + latch_time_.expected());
  add_due_flashes(t, delay, held);
  if (view_) frame.list.glows = flashes_.frame(t, frame.list.camera);
  if (settings_.event_marker == "strip")
    append_marker(frame.list.overlay, static_cast<std::uint32_t>(frame.number & 0xffffff), flashes_.shown(),
                  view_ ? view_->height() : settings_.height / 4 * 4);
  if (settings_.motion_marker == "strip")
    append_motion_marker(frame.list.overlay, static_cast<std::uint32_t>(frame.number & 0xffffff), frame.samples,
                         view_ ? view_->height() : settings_.height / 4 * 4);
  if (const std::string_view text = word(frame); !text.empty()) {
    const TextLook look = text_look(settings_.text_contrast, settings_.text_size);
    const auto width = static_cast<float>(view_ ? view_->width() : settings_.width);
    float size = look.scaled(kTextSize_px);
    while (size > 1 && kTextAt_px + text_width(text.size(), size) > width) --size;
    append_text(frame.list.overlay, text, kTextAt_px, kTextAt_px, size, look);
  }
}

void FrameComposer::assess_state(Frame& frame, sync::HostTime now, sync::HostTime newest_arrival) {
  const bool commanded = now - newest_arrival <= sync::BodyHistory::kStaleAfter;
  const bool stale = frame.status == sync::SampleStatus::kStale && !commanded;
  if (!stale) stale_since_.reset();
  if (stale && !stale_since_) stale_since_ = now;
  if (!scene_) {
    frame.note = "waits for the scene";
  } else if (frame.status == sync::SampleStatus::kNone) {
    frame.state = node_health_t::READY;
    frame.note = "waits for the state of the world";
  } else if (stale && now - *stale_since_ >= sync::from_seconds(settings_.lost_after_s)) {
    frame.state = node_health_t::INPUT_LOST;
    frame.note = "no state of the world: shows the last one";
  } else if (stale || (frame.status == sync::SampleStatus::kHeld && !commanded)) {
    frame.state = node_health_t::STALE;
    frame.note = "shows the last state of the world";
  } else {
    frame.state = node_health_t::RUNNING;
  }
}

// Expected presentation of the frame after the one that is presented at t. A late loop skips ticks.
sync::HostTime FrameComposer::next_presentation(sync::HostTime t) const {
  const sync::Nanoseconds period = sync::from_seconds(1 / settings_.rate_Hz);
  if (due_) return t + period;
  const auto ticks = std::max<std::int64_t>(1, (t - tick_ + period - sync::Nanoseconds(1)) / period);
  return tick_ + ticks * period + render_time_.expected();
}

// Shows each event in the frame that is nearest to its instant; without a delay, in the next frame.
void FrameComposer::add_due_flashes(sync::HostTime t, sync::Nanoseconds delay, sync::Nanoseconds held) {
  const auto map = contacts_.map(latched_);
  if (!map) return;
  // Without a scene no event can be shown; it stays queued until it is too late.
  sync::Nanoseconds early{0};
  if (held == sync::Nanoseconds(0))
    early = std::clamp((next_presentation(t) - t) / 2, sync::Nanoseconds(0), std::max(delay, sync::Nanoseconds(0)));
  const sync::HostTime until = (view_ ? t : t - sync::from_seconds(settings_.drop_after_s)) - delay + early;
  const auto due = contacts_.take_events(map->to_sim(until) + sync::Nanoseconds(1));
  for (const contact_event_t& event : ledger_.select_flashes(due, *map, t, delay, held)) flashes_.add(event, t);
}

std::vector<Eigen::Isometry3d> FrameComposer::body_poses(std::optional<sync::SimTime> t) {
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(scene_->bodies.size());
  for (const body_def_t& body : scene_->bodies) {
    sync::Sample<sync::BodyPose> sample;
    if (t && !body.is_static) sample = bodies_.pose(body.id, *t), poses_.add(sample.status);
    poses.push_back(sample.status == sync::SampleStatus::kNone ? to_eigen(body.pose) : to_isometry(sample.value));
  }
  return poses;
}

ToolPose FrameComposer::tool_pose(const tool_state_t& m, std::optional<sync::SimTime> t) {
  sync::Nanoseconds ahead{0};
  if (t && m.header.sim_time_ns >= 0)
    ahead = std::clamp(*t - sync::sim_time(m.header.sim_time_ns), sync::Nanoseconds(0), kMaxToolExtrapolation);
  ToolPose pose{true, to_eigen(m.device), to_eigen(m.proxy)};
  pose.device.translation() += to_eigen(m.device_velocity_m_s) * sync::to_seconds(ahead);
  pose.proxy.translation() += to_eigen(m.proxy_velocity_m_s) * sync::to_seconds(ahead);
  return pose;
}

void FrameComposer::add_tools(Frame& frame, sync::HostTime presented, sync::HostTime now) {
  if (scene_) frame.tools.resize(scene_->tools.size());
  frame.tool_forces_N.assign(frame.tools.size(), Eigen::Vector3d::Zero());
  const double dt_s = sync::to_seconds(now - std::exchange(tools_drawn_, now));
  for (auto& [tool, drawn] : tools_) {
    const ToolHistory::Report* report = presented < now ? drawn.reports.arrived_by(presented) : drawn.reports.newest();
    if (!report || presented - report->arrival > kToolStaleAfter) {
      drawn.display.reset();
      continue;
    }
    const tool_state_t& m = report->state;
    frame.samples.push_back({tool, m.header.seq});
    if (!scene_) continue;
    ToolPose& pose = frame.tools[static_cast<std::size_t>(tool)];
    pose = tool_pose(m, frame.instant);
    const Eigen::Vector3d beside = drawn.display.step(pose.proxy.translation(), settings_.display_gain, dt_s);
    for (Eigen::Isometry3d* place : {&pose.device, &pose.proxy}) place->translation() += beside;
    frame.tool_forces_N[static_cast<std::size_t>(tool)] = to_eigen(m.force_N);
  }
}

// Returns nothing when the scene's own view applies. A lost head keeps its last pose. The note of the frame reports
// both.
std::optional<Eigen::Isometry3d> FrameComposer::view_of_head(const sync::Sample<sync::BodyPose>& head,
                                                             Frame& frame) const {
  if (head_tool_ < 0) return {};
  if (head.status == sync::SampleStatus::kNone || head.status == sync::SampleStatus::kStale)
    frame.note += std::string(frame.note.empty() ? "" : "; ") + (head.status == sync::SampleStatus::kNone
                                                                     ? "no head yet: the view is the scene's"
                                                                     : "the head is lost: the view stays");
  if (head.status == sync::SampleStatus::kNone) return {};
  return view_of(*scene_, head.value.position, head.value.orientation);
}

std::vector<presentation_t> FrameComposer::presented(sync::HostTime fence) {
  render_time_.add(fence - tick_);
  latch_time_.add(fence - latched_);
  return ledger_.presented(fence);
}

}  // namespace tactus::visual
