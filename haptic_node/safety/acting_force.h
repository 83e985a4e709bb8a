// The force that really acted on the hand while the device moved: commands reach a device late, and it holds each for
// a while. Force and motion of one instant give the energy; the force commanded now and the motion reported now do not
// belong together. Pure.
#pragma once

#include <algorithm>
#include <cmath>

#include "haptic_node/devices/device.h"
#include "haptic_node/safety/history.h"

namespace tactus::haptic {

using ForceHistory = History<Wrench>;

inline Wrench plus_scaled(const Wrench& a, const Wrench& b, double scale) {
  return {a.force_N + scale * b.force_N, a.torque_N_m + scale * b.torque_N_m};
}

// Mean of a history from from_s to to_s, a value of T{} before its first entry. T has a function plus_scaled.
template <class T>
T mean_over(const History<T>& commands, double from_s, double to_s) {
  T mean{};
  std::size_t next = commands.count_until(from_s);
  double time_s = from_s;
  while (time_s < to_s && next <= commands.size()) {
    const double until_s = next < commands.size() ? std::min(to_s, commands.entry(next).time_s) : to_s;
    if (next > 0) mean = plus_scaled(mean, commands.entry(next - 1).value, (until_s - time_s) / (to_s - from_s));
    time_s = until_s;
    ++next;
  }
  return mean;
}

// Mean of the commands that acted from from_s to to_s. A device that is not immediate applies a command at the first of
// its states after the arrival (or on arrival, loop.at_once). Realtime-safe: yes.
template <class T>
T acting(const History<T>& commands, double from_s, double to_s, const DeviceLoop& loop) {
  // Rounding of times, s; also decides that a command of the same instant as a state comes after it.
  constexpr double kRounding_s = 1e-6;
  // Largest number of states of a device between two ticks that are distinguished: 4 kHz at 100 Hz.
  constexpr double kMaxStates = 40;
  // The command of the previous tick, which ended with this one.
  if (loop.immediate()) return commands.empty() ? T{} : commands.entry(commands.size() - 1).value;
  if (!(to_s > from_s)) return {};
  if (loop.at_once) return mean_over(commands, from_s - loop.force_delay_s, to_s - loop.force_delay_s);
  const double states = std::round((to_s - from_s) / std::max(loop.interval_s, kRounding_s));
  const int count = static_cast<int>(std::clamp(states, 1.0, kMaxStates));
  T mean{};
  for (int i = 0; i < count; ++i) {
    const double state_s = from_s + (to_s - from_s) * i / count;
    const double sent_s = std::min(state_s - loop.force_delay_s + kRounding_s, state_s - kRounding_s);
    mean = plus_scaled(mean, commands.at(sent_s), 1.0 / count);
  }
  return mean;
}

// The same for the motion that a tick at now_s reports, which ended loop.age_s before. dt: duration of the tick, for
// an immediate device.
template <class T>
T acting_in_tick(const History<T>& commands, double now_s, double dt, const DeviceLoop& loop) {
  const double to_s = now_s - loop.age_s;
  return acting(commands, to_s - (loop.immediate() ? dt : loop.span_s), to_s, loop);
}

// Mean force and torque that acted.
inline Wrench acting_force(const ForceHistory& commands, double from_s, double to_s, const DeviceLoop& loop) {
  return acting(commands, from_s, to_s, loop);
}

}  // namespace tactus::haptic
