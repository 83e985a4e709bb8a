#include "haptic_node/session.h"

#include <algorithm>

#include "lcmtypes/vectors.h"

namespace tactus::haptic {

std::unique_ptr<Device> device_of(const scene_t& scene, const Choice& choice, const DeviceSpec* given) {
  const tool_def_t& tool = scene.tools[static_cast<std::size_t>(choice.tool)];
  const auto& body = scene.bodies[static_cast<std::size_t>(tool.body)];
  const DeviceSpec spec = given ? *given : tool.device.empty() ? DeviceSpec{} : parse_device_spec(tool.device);
  return make_device(spec, tool, to_eigen(body.pose.position_m), choice.settings);
}

Session::Session(const scene_t& scene, const Choice& choice, std::unique_ptr<Device> device, sync::OwnClock own,
                 Safety& safety)
    : device_(std::move(device)),
      renderer_(scene, choice.tool, choice.settings, safety),
      touch_(choice.tool, own),
      events_(own) {
  safety.set_limits(safety_limits(choice.settings));
}

TickOutput& Session::step(sync::HostTime now, const Degraded& degraded) {
  TickInput in;
  in.now = now;
  in.device = device_->read(now);
  if (!over_) {
    in.fresh = touch_.take();
    // A commanded gap is not a loss.
    in.touch_arrival = touch_.arrival();
    if (in.touch_arrival && degraded.touch_arrival)
      in.touch_arrival = std::max(*in.touch_arrival, *degraded.touch_arrival);
    in.map = touch_.map(now);
  }
  in.transient_delay = degraded.delay;
  in.touch_delay = degraded.touch_delay;
  in.force_step_N = degraded.force_step_N;
  // Events are published when their time is reached, so all that have come are due.
  std::vector<contact_event_t> due;
  if (in.map) due = events_.take_events(sync::SimTime::max());
  in.events = due;
  TickOutput& out = renderer_.step(in);
  device_->write(out.force_N);
  return out;
}

}  // namespace tactus::haptic
