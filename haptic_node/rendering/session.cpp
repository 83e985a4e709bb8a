#include "haptic_node/rendering/session.h"

#include <algorithm>
#include <cstdio>
#include <tactus/scene_t.hpp>
#include <tactus/tool_def_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::haptic {
namespace {

// Maximum time from a simulation step to the tick that uses its touch model: a few steps and ticks. A larger value
// means a wrong clock.
constexpr sync::Nanoseconds kMaxModelDelay{10'000'000};

}  // namespace

std::unique_ptr<Device> make_tool_device(const scene_t& scene, const NodeConfig& config, const DeviceSpec* given) {
  const tool_def_t& tool = scene.tools[static_cast<std::size_t>(config.tool)];
  const auto& body = scene.bodies[static_cast<std::size_t>(tool.body)];
  const DeviceSpec spec = given ? *given : tool.device.empty() ? DeviceSpec{} : parse_device_spec(tool.device);
  return make_device(spec, tool, to_eigen(body.pose.position_m), config.settings,
                     to_eigen(body.pose.orientation).normalized());
}

Session::Session(const scene_t& scene, const NodeConfig& config, std::unique_ptr<Device> device,
                 sync::OwnClock own, Safety& safety)
    : device_(std::move(device)),
      safety_(safety),
      renderer_(scene, config.tool, config.settings, safety),
      touch_(config.tool, own),
      watchdog_(config.tool, own) {
  safety.set_limits(safety_limits(config.settings));
  device_->set_clock(own);
  safety.release();
}

void Session::change(const Settings& settings) {
  safety_.set_limits(safety_limits(settings));
  renderer_.change(settings);
}

// The path of the device begins at the simulated instant of the first touch model, so that it is equal in every
// run. With an intended delay that model is not available yet; the path then begins at its arrival.
void Session::start_path(sync::HostTime now, const TouchModelView& fresh, std::optional<sync::HostTime> arrival) {
  if (!first_tick_) first_tick_ = now;
  const bool arrived = arrival && *arrival >= *first_tick_;
  if (path_started_ || (!fresh && !arrived)) return;
  path_started_ = true;
  const auto map = touch_.map(now);
  const sync::HostTime at = fresh && map ? map->to_host(sync::sim_time(fresh.header().sim_time_ns)) : now;
  device_->begin(std::clamp(at, now - kMaxModelDelay, now));
}

std::string Session::device_text(sync::HostTime now) const {
  if (device_lost()) return device_->problem(now);
  const Renderer::DeviceLimit limit = renderer_.device_limit();
  if (!limit.softened) return "";
  char text[160];
  std::snprintf(text, sizeof text,
                "the device sends every %.1f ms and its force acts %.0f ms later: touch is softer, at most %.0f N/m",
                1e3 * limit.loop.period_s, 1e3 * limit.loop.delay_s, limit.stiffness_N_m);
  return text;
}

TickOutput& Session::step(sync::HostTime now, const Degraded& degraded, std::size_t planes) {
  TickInput in;
  in.now = now;
  if (!ended_) {
    in.fresh = touch_.pop();
    in.restarted = touch_.take_restart();
    const auto arrival = degraded.touch_arrival ? degraded.touch_arrival : watchdog_.arrival();
    start_path(now, in.fresh, arrival);
    // An intended gap is not a loss, and delayed models do not outlive the simulation.
    in.touch_arrival = touch_.arrival();
    if (in.touch_arrival && arrival) in.touch_arrival = arrival;
    // Pages that never complete a model do not count as a touch model.
    if (in.touch_arrival && touch_.unfinished_since())
      in.touch_arrival = std::min(*in.touch_arrival, *touch_.unfinished_since());
    in.map = touch_.map(now);
  }
  in.device = device_->read(now);
  in.transient_delay = degraded.delay;
  in.touch_delay = degraded.touch_delay;
  in.force_step_N = degraded.force_step_N;
  in.force_stage = degraded.force_stage;
  in.force_decisions = degraded.force_decisions;
  in.action_delay_s = sync::to_seconds(degraded.action_delay);
  in.planes = planes;
  rendered_.clear();
  if (in.map) rendered_.swap(events_);
  in.events = rendered_;
  TickOutput& out = renderer_.step(in);
  device_->write(Wrench{out.force_N, out.torque_N_m});
  return out;
}

}  // namespace tactus::haptic
