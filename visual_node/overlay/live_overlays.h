// All overlays of a running node: subscribes to their inputs, stores them, and adds the overlays to each frame. An
// overlay that is off costs no subscription, storage or drawing.
#pragma once

#include <map>
#include <string>
#include <tactus/world_state_t.hpp>
#include <vector>

#include "sync/bus/bus.h"
#include "sync/resampling/contact_stream.h"
#include "visual_node/frame/frame_composer.h"
#include "visual_node/overlay/body_groups.h"
#include "visual_node/overlay/overlay_set.h"
#include "visual_node/overlay/panel.h"
#include "visual_node/overlay/plots.h"

namespace tactus::visual {

class LiveOverlays {
 public:
  // events: those of the node; it outlives this object.
  LiveOverlays(sync::Bus& bus, sync::EventInbox& events) : bus_(bus), contacts_(events) {}

  // Throws std::invalid_argument with one sentence for an unknown overlay or plot; changes nothing.
  static void check(const Settings& settings);
  // Applies the valid part of the settings; returns a sentence for each invalid part.
  std::vector<std::string> configure(const Settings& settings);
  void toggle(Overlay o);
  const OverlaySet& on() const { return on_; }

  // A message that the node receives anyway.
  void push(const world_state_t& m) {
    if (on_.on(Overlay::kGroups)) body_groups_.push(m);
  }

  // Call before a frame is composed: sets the colours of its bodies.
  void tint(FrameComposer& composer, std::size_t bodies);
  // Call when its surfaces and flashes are drawn: adds lines, text and plots. data: the values of the node itself;
  // the function fills in the rest.
  void append(Frame& frame, PanelData data, sync::HostTime now, int picture_width, int picture_height);

 private:
  static constexpr int kMaxTools = 64;
  bool needs_contacts() const {
    return on_.on(Overlay::kContacts) || on_.on(Overlay::kForces) || on_.on(Overlay::kReport);
  }
  void subscribe();
  void receive();
  std::vector<InputLine> inputs(const Frame& frame, sync::SampleStatus contacts, sync::HostTime now) const;

  sync::Bus& bus_;
  OverlaySet on_;
  TextLook look_;
  float force_scale_m_N_ = 0;
  int markers_px_ = 0;  // height of the lower edge that programs read
  Plots plots_{{}, sync::Nanoseconds(1)};
  std::map<std::string, sync::RawQueue*>
      queues_;  // by channel; a queue stays with the bus once created, used or not
  sync::ContactStream contacts_;
  BodyGroups body_groups_;
  bool tinted_ = false;
  TickTimes physics_;
};

}  // namespace tactus::visual
