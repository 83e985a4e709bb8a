// All overlays of a running node: hears what they need, keeps it, and adds them to each frame. What is off is not
// heard, not kept and not drawn.
#pragma once

#include <map>
#include <string>
#include <tactus/contact_events_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/world_state_t.hpp>
#include <vector>

#include "sync/bus/bus.h"
#include "sync/resampling/contact_stream.h"
#include "visual_node/frame/frame_composer.h"
#include "visual_node/overlay/groups.h"
#include "visual_node/overlay/kinds.h"
#include "visual_node/overlay/panel.h"
#include "visual_node/overlay/plots.h"

namespace tactus::visual {

class LiveOverlays {
 public:
  explicit LiveOverlays(sync::Bus& bus) : bus_(bus), contacts_(bus.clocks()) {}

  // Throws std::invalid_argument with one sentence for an overlay or a plot that there is not; then nothing has
  // changed.
  static void check(const Settings& settings);
  // What of it can be drawn; a sentence for each thing that cannot.
  std::vector<std::string> configure(const Settings& settings);
  void toggle(Overlay o);
  const OverlaySet& on() const { return on_; }

  // What the node hears anyway.
  void push(const world_state_t& m) {
    if (on_.on(Overlay::kGroups)) groups_.push(m);
  }
  void push(const contact_events_t& m, sync::HostTime arrival) {
    if (wants_contacts()) contacts_.push(m, arrival);
  }
  void push(const tool_state_t& m) {
    if (on_.on(Overlay::kForces)) tools_[m.tool] = m;
  }

  // Before a frame is composed: colours of its bodies.
  void tint(FrameComposer& composer, std::size_t bodies);
  // Its surfaces and flashes are there: adds lines, words and plots. facts: what the node knows of itself; the
  // rest is filled in.
  void append(Frame& frame, PanelFacts facts, sync::HostTime now, int picture_width, int picture_height);

 private:
  static constexpr int kMaxTools = 64;
  bool wants_contacts() const {
    return on_.on(Overlay::kContacts) || on_.on(Overlay::kForces) || on_.on(Overlay::kReport);
  }
  void listen();
  void hear();
  std::vector<InputLine> inputs(const Frame& frame, sync::SampleStatus contacts, sync::HostTime now) const;

  sync::Bus& bus_;
  OverlaySet on_;
  float force_scale_m_N_ = 0;
  int markers_px_ = 0;  // of the lower edge, where programs read
  Plots plots_{{}, sync::Nanoseconds(1)};
  std::map<std::string, sync::RawQueue*>
      heard_;  // by channel; once heard, a queue stays with the bus, wanted or not
  sync::ContactStream contacts_;
  Groups groups_;
  bool tinted_ = false;
  TickTimes physics_;
  std::map<int, tool_state_t> tools_;
};

}  // namespace tactus::visual
