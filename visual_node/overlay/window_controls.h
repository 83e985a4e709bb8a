// The window's keys and mouse on a running node: overlays, the simulation, the lamp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <tactus/sim_reply_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/bus/bus.h"
#include "visual_node/overlay/desk.h"
#include "visual_node/overlay/live.h"
#include "visual_node/overlay/live_questions.h"

namespace tactus::visual {

class WindowControls {
 public:
  using Say = std::function<void(const std::string&)>;
  explicit WindowControls(sync::Bus& bus) : bus_(bus) {}

  void push(const world_state_t& m) { wishes_.push(m); }
  // Once a tick. list, geometries: of the picture that is shown; say: hears one sentence on each thing worth one.
  // What a study asks comes first: a key that answers it does nothing else.
  void step(sync::HostTime now, Display& display, LiveOverlays& overlays, LiveQuestions& questions,
            const DrawList& list, std::span<const Triangles> geometries, const Say& say);
  bool closing() const { return closing_; }

 private:
  void heed(const Wish& wish, Display& display, LiveOverlays& overlays);

  sync::Bus& bus_;
  sync::Queue<sim_reply_t>* replies_ = nullptr;  // once there is a window
  SimulationWishes wishes_;
  MousePointer pointer_;
  bool closing_ = false;
};

}  // namespace tactus::visual
