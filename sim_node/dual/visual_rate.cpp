#include "sim_node/dual/visual_rate.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim {

void VisualRate::set(double rate_Hz) {
  rate_Hz_ = std::clamp(rate_Hz, kLeast_Hz, kMax_Hz);
  steps_ = begun_ = 0;
}

sync::Nanoseconds VisualRate::next() {
  const double ticks_per_second = 1 / sync::to_seconds(tick_);
  // Whole numbers that rounding has pushed up stay what they are.
  const auto begin =
      static_cast<std::int64_t>(std::ceil(static_cast<double>(++steps_) * ticks_per_second / rate_Hz_ - 1e-9));
  const std::int64_t length = begin - begun_;
  begun_ = begin;
  return length * tick_;
}

}  // namespace tactus::sim
