// One tool of one scene with its device, from the messages that arrive to the state of the tool. Pure: no bus, no
// clock.
#pragma once

#include <memory>
#include <optional>
#include <tactus/contact_events_t.hpp>
#include <tactus/device_force_t.hpp>
#include <tactus/device_state_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/touch_model_t.hpp>
#include <utility>

#include "haptic_node/devices/selection/node_config.h"
#include "haptic_node/devices/selection/make_device.h"
#include "haptic_node/rendering/renderer.h"
#include "haptic_node/contact/touch_input.h"
#include "sync/resampling/contact_stream.h"

namespace tactus::haptic {

// What a policy or a profile does to this sense.
struct Degraded {
  sync::Nanoseconds delay{0};        // of hit transients, on top of the setting
  sync::Nanoseconds touch_delay{0};  // by which touch models are held back
  double force_step_N = 0;           // of the force that is commanded; 0: none
  // When the newest touch model really arrived; nothing: as it came here.
  std::optional<sync::HostTime> touch_arrival;
};

// The device of the tool that was chosen. given: from the command line; null: as the tool says, maybe from a
// file, so not for a loop. Throws std::runtime_error with one sentence when there is no such device.
std::unique_ptr<Device> device_of(const scene_t& scene, const NodeConfig& choice, const DeviceSpec* given = nullptr);

class Session {
 public:
  // choice.tool must be one of the scene's. safety: of the process, outlives this; it goes on with the limits of
  // this scene.
  Session(const scene_t& scene, const NodeConfig& choice, std::unique_ptr<Device> device, sync::OwnClock own,
          Safety& safety);

  void push(touch_model_t page, sync::HostTime arrival) {
    if (!over_) touch_.push(std::move(page), arrival);
  }
  void push(const contact_events_t& events, sync::HostTime arrival) {
    if (!over_) events_.push(events, arrival);
  }

  // Other settings from the next tick on, as Renderer::change; with the limits of safety.
  void change(const Settings& settings);

  // Of this scene, when they have been read; until then its surfaces are smooth.
  void set_maps(std::shared_ptr<const SurfaceMaps> maps) { renderer_.set_maps(std::move(maps)); }

  void push(const device_state_t& state, sync::HostTime arrival) { device_->hear(state, arrival); }
  void push(const device_force_t& others, sync::HostTime arrival) { device_->hear(others, arrival); }
  // After a step: what a program that drives the device must be told; null: nothing.
  device_force_t* tell() { return device_->tell(); }

  // Once a tick: reads the device, renders, commands the device. planes: so many are considered. The output is
  // valid, and may be stamped, until the next.
  TickOutput& step(sync::HostTime now, const Degraded& degraded = {}, std::size_t planes = Surfaces::kMaxPresent);

  // Its scene is over: from now on what comes is ignored, and the force goes to zero as fast as the limits
  // allow.
  void let_go() { over_ = true; }
  bool over() const { return over_; }

  bool heard() const { return touch_.arrival().has_value(); }  // a touch model has come
  bool lost() const { return renderer_.lost(); }
  bool device_lost() const { return renderer_.device_lost(); }

 private:
  void begin_path(sync::HostTime now, const TouchModelView& fresh, const Degraded& degraded);

  std::unique_ptr<Device> device_;
  Safety& safety_;
  Renderer renderer_;
  TouchInput touch_;
  sync::ContactStream events_;
  bool over_ = false;
  std::optional<sync::HostTime> since_;  // the first tick
  bool path_begun_ = false;
};

}  // namespace tactus::haptic
