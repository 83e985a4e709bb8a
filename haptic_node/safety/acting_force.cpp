#include "haptic_node/safety/acting_force.h"

#include <algorithm>
#include <cmath>

namespace tactus::haptic {
namespace {

// Rounding of times, s; also decides that a command of the same instant as a state comes after it.
constexpr double kRounding_s = 1e-6;
// Largest number of states of a device between two ticks that are distinguished: 4 kHz at 100 Hz.
constexpr int kMaxStates = 40;

Wrench sum(const Wrench& a, const Wrench& b, double weight) {
  return {a.force_N + weight * b.force_N, a.torque_N_m + weight * b.torque_N_m};
}

// A force that acts on arrival: the mean over the interval of its arrivals.
Wrench mean_over(const ForceHistory& commands, double from_s, double to_s) {
  Wrench mean;
  std::size_t next = commands.count_until(from_s);
  double time_s = from_s;
  while (time_s < to_s) {
    const double until_s = next < commands.size() ? std::min(to_s, commands.entry(next).time_s) : to_s;
    if (next > 0) mean = sum(mean, commands.entry(next - 1).value, (until_s - time_s) / (to_s - from_s));
    time_s = until_s;
    ++next;
    if (next > commands.size()) break;
  }
  return mean;
}

}  // namespace

Wrench acting_force(const ForceHistory& commands, double from_s, double to_s, const DeviceLoop& loop) {
  // The command of the previous tick, which ended with this one.
  if (loop.immediate()) return commands.empty() ? Wrench{} : commands.entry(commands.size() - 1).value;
  if (!(to_s > from_s)) return {};
  if (loop.at_once) return mean_over(commands, from_s - loop.force_delay_s, to_s - loop.force_delay_s);
  const double states = std::round((to_s - from_s) / std::max(loop.interval_s, kRounding_s));
  const int count = static_cast<int>(std::clamp(states, 1.0, static_cast<double>(kMaxStates)));
  Wrench mean;
  for (int i = 0; i < count; ++i) {
    const double state_s = from_s + (to_s - from_s) * i / count;
    const double sent_s = std::min(state_s - loop.force_delay_s + kRounding_s, state_s - kRounding_s);
    mean = sum(mean, commands.at(sent_s), 1.0 / count);
  }
  return mean;
}

}  // namespace tactus::haptic
