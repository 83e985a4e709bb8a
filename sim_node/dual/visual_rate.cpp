#include "sim_node/dual/visual_rate.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim {

void VisualRate::set(double rate_Hz) {
  rate_Hz_ = std::clamp(rate_Hz, kMin_Hz, kMax_Hz);
  steps_ = begun_ = 0;
}

sync::Nanoseconds VisualRate::next() {
  const double ticks_per_second = 1 / sync::to_seconds(tick_);
  // Rounding must not push a whole number up to the next one.
  const auto begin =
      static_cast<std::int64_t>(std::ceil(static_cast<double>(++steps_) * ticks_per_second / rate_Hz_ - 1e-9));
  const std::int64_t length = begin - begun_;
  begun_ = begin;
  return length * tick_;
}

}  // namespace tactus::sim
