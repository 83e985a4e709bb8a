// The force that really acted on the hand while the device moved: commands reach a device late, and it holds each for
// a while. Force and motion of one instant give the energy; the force commanded now and the motion reported now do not
// belong together. Pure.
#pragma once

#include "haptic_node/devices/device.h"
#include "haptic_node/safety/history.h"

namespace tactus::haptic {

using ForceHistory = History<Wrench>;

// Mean force and torque that acted from from_s to to_s, of the history of commands. A device that is not immediate
// applies a command at the first of its states after the arrival (or on arrival, loop.at_once). Realtime-safe: yes.
Wrench acting_force(const ForceHistory& commands, double from_s, double to_s, const DeviceLoop& loop);

// The same for the motion that a tick at now_s reports, which ended loop.age_s before. dt: duration of the tick, for
// an immediate device.
inline Wrench acting_force_of_tick(const ForceHistory& commands, double now_s, double dt, const DeviceLoop& loop) {
  const double to_s = now_s - loop.age_s;
  return acting_force(commands, to_s - (loop.immediate() ? dt : loop.span_s), to_s, loop);
}

}  // namespace tactus::haptic
