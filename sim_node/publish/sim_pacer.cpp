#include "sim_node/publish/sim_pacer.h"

#include <cmath>

namespace tactus::sim {

sync::TimeMap SimPacer::tick(sync::SimTime sim, sync::HostTime due) {
  const std::int64_t measured = sync::to_ns(due) - sync::to_ns(sim);
  double rate = 1;
  if (held_) {
    held_.reset();
    offset_ns_.reset();
  }
  if (!offset_ns_) {
    base_ns_ = measured;
    offset_ns_ = 0;
    window_host_ = due, window_sim_ = sim;
  } else {
    const double step_s = sync::to_seconds(sim - last_sim_);
    const double error_ns = static_cast<double>(measured - base_ns_) - *offset_ns_;
    const double slew_ns = error_ns * (1 - std::exp(-step_s / kFollow_s));
    *offset_ns_ += slew_ns;
    if (step_s > 0) rate = step_s / (step_s + slew_ns * 1e-9);
  }
  last_sim_ = sim;
  const double window_s = sync::to_seconds(due - window_host_);
  if (window_s >= 1) {
    factor_ = sync::to_seconds(sim - window_sim_) / window_s;
    window_host_ = due, window_sim_ = sim;
  }
  return {sim, host_of(sim), rate};
}

sync::TimeMap SimPacer::hold(sync::SimTime sim, sync::HostTime due) {
  if (!held_) held_ = offset_ns_ ? host_of(sim) : due;
  return {sim, *held_, 0};
}

}  // namespace tactus::sim
