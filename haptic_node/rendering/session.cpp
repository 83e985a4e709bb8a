#include "haptic_node/rendering/session.h"

#include <algorithm>
#include <tactus/contact_event_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_def_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "lcmtypes/vectors.h"

namespace tactus::haptic {
namespace {

// Maximum time from a simulation step to the tick that uses its touch model: a few steps and ticks. A larger value
// means a wrong clock.
constexpr sync::Nanoseconds kLongestWay{10'000'000};

}  // namespace

std::unique_ptr<Device> device_of(const scene_t& scene, const NodeConfig& choice, const DeviceSpec* given) {
  const tool_def_t& tool = scene.tools[static_cast<std::size_t>(choice.tool)];
  const auto& body = scene.bodies[static_cast<std::size_t>(tool.body)];
  const DeviceSpec spec = given ? *given : tool.device.empty() ? DeviceSpec{} : parse_device_spec(tool.device);
  return make_device(spec, tool, to_eigen(body.pose.position_m), choice.settings,
                     to_eigen(body.pose.orientation).normalized());
}

Session::Session(const scene_t& scene, const NodeConfig& choice, std::unique_ptr<Device> device, sync::OwnClock own,
                 Safety& safety)
    : device_(std::move(device)),
      safety_(safety),
      renderer_(scene, choice.tool, choice.settings, safety),
      touch_(choice.tool, own) {
  safety.set_limits(safety_limits(choice.settings));
}

void Session::change(const Settings& settings) {
  safety_.set_limits(safety_limits(settings));
  renderer_.change(settings);
}

// The path of the device begins with the world: at the instant of the first touch model, to which simulated time
// gives the same place in every run. One that is held back on purpose is not seen yet; then it is the arrival that
// counts.
void Session::begin_path(sync::HostTime now, const TouchModelView& fresh, const Degraded& degraded) {
  if (!since_) since_ = now;
  const bool arrived = degraded.touch_arrival && *degraded.touch_arrival >= *since_;
  if (path_begun_ || (!fresh && !arrived)) return;
  path_begun_ = true;
  const auto map = touch_.map(now);
  const sync::HostTime at = fresh && map ? map->to_host(sync::sim_time(fresh.header().sim_time_ns)) : now;
  device_->begin(std::clamp(at, now - kLongestWay, now));
}

TickOutput& Session::step(sync::HostTime now, const Degraded& degraded, std::size_t planes) {
  TickInput in;
  in.now = now;
  if (!over_) {
    in.fresh = touch_.take();
    begin_path(now, in.fresh, degraded);
    // An intended gap is not a loss.
    in.touch_arrival = touch_.arrival();
    if (in.touch_arrival && degraded.touch_arrival)
      in.touch_arrival = std::max(*in.touch_arrival, *degraded.touch_arrival);
    // Pages that never complete a model do not count as a touch model.
    if (in.touch_arrival && touch_.unfinished_since())
      in.touch_arrival = std::min(*in.touch_arrival, *touch_.unfinished_since());
    in.map = touch_.map(now);
  }
  in.device = device_->read(now);
  in.transient_delay = degraded.delay;
  in.touch_delay = degraded.touch_delay;
  in.force_step_N = degraded.force_step_N;
  in.planes = planes;
  rendered_.clear();
  if (in.map) rendered_.swap(events_);
  in.events = rendered_;
  TickOutput& out = renderer_.step(in);
  device_->write(Wrench{out.force_N, out.torque_N_m});
  return out;
}

}  // namespace tactus::haptic
