#include "visual_node/overlay/live_overlays.h"

#include <algorithm>
#include <stdexcept>
#include <tactus/contact_frame_t.hpp>
#include <tactus/node_health_t.hpp>

#include "sync/bus/decode.h"
#include "visual_node/frame/motion_marker.h"
#include "visual_node/frame/text.h"
#include "visual_node/overlay/contact_strokes.h"

namespace tactus::visual {
namespace {

// Queue length: the messages of a channel between two frames. A state of 1 kHz for a tenth of a second, or two
// snapshots of 300 contacts.
constexpr std::size_t kQueueLength = 256;
// The first line is below the status word of the frame, which is 22 pixels high and begins at 8.
constexpr float kPanelAt_px = 8, kStatusSize_px = 2, kPanelGap_px = 6;

}  // namespace

void LiveOverlays::check(const Settings& settings) {
  parse_overlays(settings.overlay);
  std::vector<std::string> warnings;
  parse_plots(settings.plots, warnings);
  if (!warnings.empty()) throw std::invalid_argument(warnings.front());
}

std::vector<std::string> LiveOverlays::configure(const Settings& settings) {
  std::vector<std::string> warnings;
  try {
    on_ = parse_overlays(settings.overlay);
  } catch (const std::invalid_argument& e) {
    warnings.emplace_back(e.what());
  }
  markers_px_ = marker_height_px(settings.event_marker == "strip", settings.motion_marker == "strip");
  look_ = text_look(settings.text_contrast, settings.text_size);
  force_scale_m_N_ = static_cast<float>(settings.force_scale_m_N);
  plots_ = Plots(parse_plots(settings.plots, warnings), sync::from_seconds(settings.plot_span_s));
  if (!plots_.empty()) on_.set(Overlay::kPlots);
  body_groups_.reset();
  subscribe();
  return warnings;
}

void LiveOverlays::toggle(Overlay o) {
  on_.toggle(o);
  subscribe();
}

void LiveOverlays::subscribe() {
  std::vector<std::string> wanted;
  if (on_.on(Overlay::kPlots)) wanted = plots_.channels();
  if (needs_contacts()) wanted.emplace_back(channels::kContacts);
  if (on_.on(Overlay::kReport)) wanted.emplace_back(channels::kNodeHealth);
  for (auto& [channel, queue] : queues_)
    queue->set_enabled(std::find(wanted.begin(), wanted.end(), channel) != wanted.end());
  for (const std::string& channel : wanted)
    if (!queues_.contains(channel)) queues_[channel] = &bus_.raw(channel.c_str(), kQueueLength);
  if (!on_.on(Overlay::kGroups)) body_groups_.reset();
}

void LiveOverlays::receive() {
  for (auto& [channel, queue] : queues_)
    queue->read([&, &name = channel](std::span<const std::uint8_t> bytes, sync::HostTime arrival) {
      if (on_.on(Overlay::kPlots)) plots_.push(name, bytes, arrival);
      if (name == channels::kContacts && needs_contacts())
        if (const auto m = sync::decode<contact_frame_t>(bytes.data(), bytes.size())) contacts_.push(*m, arrival);
      if (name == channels::kNodeHealth && on_.on(Overlay::kReport))
        if (const auto m = sync::decode<node_health_t>(bytes.data(), bytes.size()); m && m->node == "sim_node")
          physics_.push(*m);
    });
}

void LiveOverlays::tint(FrameComposer& composer, std::size_t bodies) {
  const bool now = on_.on(Overlay::kGroups);
  if (now || tinted_) composer.tint(now ? body_groups_.tints(bodies) : std::vector<Eigen::Vector4f>{});
  tinted_ = now;
}

std::vector<InputLine> LiveOverlays::inputs(const Frame& frame, sync::SampleStatus contacts,
                                            sync::HostTime now) const {
  std::vector<InputLine> lines;
  for (const char* channel :
       {channels::kWorldState, channels::kContactEvents, channels::kToolState, channels::kContacts})
    for (const auto& inbox : bus_.inboxes()) {
      if (inbox->count().channel != channel) continue;
      InputLine line{channel, sync::age_of(inbox->count(), bus_.clocks(), now), sync::SampleStatus::kNone};
      if (line.age.age < sync::Nanoseconds(0) && inbox->count().newest_arrival != sync::HostTime{})
        line.age.age = now - inbox->count().newest_arrival;
      if (channel == channels::kWorldState) line.status = frame.status;
      if (channel == channels::kContacts) line.status = contacts;
      lines.push_back(line);
      break;
    }
  return lines;
}

void LiveOverlays::append(Frame& frame, PanelData data, sync::HostTime now, int picture_width,
                          int picture_height) {
  if (!on_.any()) return;
  receive();
  sync::Sample<sync::Contacts> touching;
  if (needs_contacts() && frame.instant) touching = contacts_.state_at(*frame.instant);
  auto& strokes = frame.list.strokes;
  const Eigen::Vector3d& origin_m = frame.list.camera.origin_m;
  if (on_.on(Overlay::kContacts)) append_contacts(strokes, touching.value, origin_m);
  if (on_.on(Overlay::kForces)) append_contact_forces(strokes, touching.value, force_scale_m_N_, origin_m);
  for (std::size_t i = 0; i < std::min<std::size_t>(frame.tools.size(), kMaxTools); ++i) {
    if (on_.on(Overlay::kTools)) append_tool(strokes, frame.tools[i], origin_m);
    if (on_.on(Overlay::kForces) && i < frame.tool_forces_N.size())
      append_hand_force(strokes, frame.tools[i], frame.tool_forces_N[i], force_scale_m_N_, origin_m);
  }
  data.contacts = touching.value.size();
  data.physics = physics_;
  data.haptic_bodies = body_groups_.haptic();
  data.visual_bodies = body_groups_.visual();
  if (on_.on(Overlay::kAges)) data.inputs = inputs(frame, touching.status, now);
  // Nothing is drawn over the markers at the lower edge, which programs read.
  const float bottom = static_cast<float>(picture_height - markers_px_);
  float right = static_cast<float>(picture_width);
  if (on_.on(Overlay::kPlots) && !plots_.empty()) {
    right = plots_left(picture_width);
    plots_.append(frame.list.overlay, now, picture_width, picture_height - markers_px_, look_);
  }
  const float below = kPanelAt_px + text_height(look_.scaled(kStatusSize_px)) + kPanelGap_px;
  append_lines(frame.list.overlay, panel_lines(on_, data), {kPanelAt_px, below, right, bottom}, text_size(picture_height, look_),
               look_);
}

}  // namespace tactus::visual
