// Keys and mouse of the window on a running node: overlays, the simulation, the lamp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <tactus/sim_reply_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/bus/bus.h"
#include "visual_node/overlay/live_overlays.h"
#include "visual_node/overlay/live_questions.h"
#include "visual_node/overlay/simulation_requests.h"

namespace tactus::visual {

class WindowControls {
 public:
  using Report = std::function<void(const std::string&)>;
  explicit WindowControls(sync::Bus& bus) : bus_(bus) {}

  void push(const world_state_t& m) { requests_.push(m); }
  // Call once a tick. list, geometries: of the shown picture; report: receives sentences for the user. The
  // questions of a study have priority: a key that answers one does nothing else.
  void step(sync::HostTime now, Display& display, LiveOverlays& overlays, LiveQuestions& questions,
            const DrawList& list, std::span<const Triangles> geometries, const Report& report);
  bool closing() const { return closing_; }

 private:
  void execute(const KeyAction& key_action, Display& display, LiveOverlays& overlays);

  sync::Bus& bus_;
  sync::Queue<sim_reply_t>* replies_ = nullptr;  // set once there is a window
  SimulationRequests requests_;
  MousePointer pointer_;
  bool closing_ = false;
};

}  // namespace tactus::visual
