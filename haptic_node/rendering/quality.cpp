#include "haptic_node/rendering/quality.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tactus::haptic {
namespace {

// Share of a tick; the rest covers late wake-ups and other processes (design).
constexpr double kBudget = 0.5;
// Rate of the means that the ladder receives. Design, as for pictures: at the rate of the loop the ladder would
// react to every moment in which another process has the processor; fewer planes do not help there.
constexpr double kMeans_Hz = 60;
constexpr double kCalm_s = 2;  // design: spare time required before a better step

}  // namespace

Quality::Quality(const Settings& s)
    : ladder_(steps(), sync::from_seconds(kBudget / s.rate_Hz), static_cast<int>(kCalm_s * kMeans_Hz)),
      ticks_per_mean_(std::max(1, static_cast<int>(std::lround(s.rate_Hz / kMeans_Hz)))),
      fixed_step_(s.quality == "auto" ? -1 : std::stoi(s.quality)) {}

void Quality::add(sync::Nanoseconds used) {
  if (fixed_step_ >= 0) return;
  used_ += used;
  if (++ticks_ < ticks_per_mean_) return;
  ladder_.add(used_ / ticks_);
  ticks_ = 0;
  used_ = sync::Nanoseconds(0);
}

}  // namespace tactus::haptic
