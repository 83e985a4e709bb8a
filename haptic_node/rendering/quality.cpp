#include "haptic_node/rendering/quality.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tactus::haptic {
namespace {

// Share of a tick; the rest is for a wake-up that comes late and for others (design).
constexpr double kBudget = 0.5;
// The ladder is told of so many means a second. Design, as pictures: at the rate of the loop it would heed every
// moment in which another process has the processor, to which fewer planes are no answer.
constexpr double kMeans_Hz = 60;
constexpr double kCalm_s = 2;  // design: no better step without so much spare time

}  // namespace

Quality::Quality(const Settings& s)
    : ladder_(steps(), sync::from_seconds(kBudget / s.rate_Hz), static_cast<int>(kCalm_s * kMeans_Hz)),
      together_(std::max(1, static_cast<int>(std::lround(s.rate_Hz / kMeans_Hz)))),
      held_(s.quality == "auto" ? -1 : std::stoi(s.quality)) {}

void Quality::add(sync::Nanoseconds used) {
  if (held_ >= 0) return;
  used_ += used;
  if (++ticks_ < together_) return;
  ladder_.add(used_ / ticks_);
  ticks_ = 0;
  used_ = sync::Nanoseconds(0);
}

}  // namespace tactus::haptic
