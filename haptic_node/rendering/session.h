// One tool of one scene with its device: from the arriving messages to the tool state. Pure: no bus, no clock.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <tactus/contact_event_t.hpp>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <utility>
#include <vector>

#include "haptic_node/devices/selection/node_config.h"
#include "haptic_node/devices/selection/make_device.h"
#include "haptic_node/rendering/renderer.h"
#include "haptic_node/contact/touch_input.h"
#include "haptic_node/contact/touch_watchdog.h"

namespace tactus::haptic {

// Degradation by a playout policy or a profile.
struct Degraded {
  sync::Nanoseconds delay{0};        // of hit transients, in addition to the setting
  sync::Nanoseconds touch_delay{0};  // intended delay of the touch models
  double force_step_N = 0;           // step of the commanded force; 0: no steps
  sync::OperatorChain* force_stage = nullptr;  // operators of the stage `force`, and the list for their decisions
  sync::Decisions* force_decisions = nullptr;
  sync::Nanoseconds action_delay{0};  // of the hand on its way to the world, by the stage `action`
  // Replaces the measured arrival of the newest touch model (Session::observe_arrival); for tools that need none.
  std::optional<sync::HostTime> touch_arrival;
};

// Makes the device of the selected tool. given: from the command line; null: the device of the scene. It may read
// a file, so do not call it in a loop. Throws std::runtime_error with one sentence when there is no such device.
std::unique_ptr<Device> make_tool_device(const scene_t& scene, const NodeConfig& config,
                                         const DeviceSpec* given = nullptr);

class Session {
 public:
  // config.tool must be a tool of the scene. safety: belongs to the process and outlives this; it receives the
  // limits of this scene.
  Session(const scene_t& scene, const NodeConfig& config, std::unique_ptr<Device> device, sync::OwnClock own,
          Safety& safety);

  void push(touch_model_t page, sync::HostTime arrival) {
    if (!ended_) touch_.push(std::move(page), arrival);
  }
  // The same page as it arrived from the bus, before the operators of a profile. When no page of the tool is observed, the
  // arrivals of push() count.
  void observe_arrival(const touch_model_t& page, sync::HostTime arrival) { watchdog_.observe(page, arrival); }
  // Adds events that are due, in order of time; pass each event once. They are rendered in the next tick that can convert
  // simulated to host time. Beyond kMaxEvents waiting ones the latest are dropped.
  static constexpr std::size_t kMaxEvents = 4096;
  void push(const std::vector<contact_event_t>& due) {
    const std::size_t count = ended_ ? 0 : std::min(due.size(), kMaxEvents - events_.size());
    events_.insert(events_.end(), due.begin(), due.begin() + static_cast<std::ptrdiff_t>(count));
  }

  // Applies changed settings from the next tick on, like Renderer::change, and also the safety limits.
  void change(const Settings& settings);

  // Call it when the maps of this scene are loaded. Until then its surfaces are smooth.
  void set_maps(std::shared_ptr<const SurfaceMaps> maps) { renderer_.set_maps(std::move(maps)); }

  void push(const device_state_t& state, sync::HostTime arrival) { device_->on_message(state, arrival); }
  void push(const device_force_t& others, sync::HostTime arrival) { device_->on_message(others, arrival); }
  // Call it after step(). Returns the message for the program that drives the device; null: none.
  device_force_t* force_message() { return device_->force_message(); }

  // Call once per tick: reads the device, renders and commands the device. planes: number of planes to consider.
  // The output is valid, and may be stamped, until the next call.
  TickOutput& step(sync::HostTime now, const Degraded& degraded = {}, std::size_t planes = Surfaces::kMaxPresent);

  // Ends the scene: later messages are ignored, and the force fades to zero.
  void end() { ended_ = true; }
  bool ended() const { return ended_; }

  bool has_touch_model() const { return touch_.arrival().has_value(); }  // a touch model has arrived
  bool lost() const { return renderer_.lost(); }
  bool device_lost() const { return renderer_.device_lost(); }
  // Why the device is lost, or how its timing softens touch, without the end of the sentence; empty: neither, or not
  // known. now: of the last step.
  std::string device_text(sync::HostTime now) const;
  Renderer::DeviceLimit device_limit() const { return renderer_.device_limit(); }

 private:
  void start_path(sync::HostTime now, const TouchModelView& fresh, std::optional<sync::HostTime> arrival);

  std::unique_ptr<Device> device_;
  Safety& safety_;
  Renderer renderer_;
  TouchInput touch_;
  TouchWatchdog watchdog_;
  std::vector<contact_event_t> events_, rendered_;  // waiting; of this tick
  bool ended_ = false;
  std::optional<sync::HostTime> first_tick_;  // time of the first tick
  bool path_started_ = false;
};

}  // namespace tactus::haptic
