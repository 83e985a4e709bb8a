#include "thermal_node/display/following.h"

#include <algorithm>

namespace tactus::thermal {

Following::Result Following::step(double command_degC, double plate_degC, bool limited, double neutral_degC,
                                  double dt_s) {
  if (!(dt_s > 0)) dt_s = 0;
  if (!reachable_) reachable_ = {plate_degC, plate_degC};
  const double way_K = kSlowest_K_s * dt_s;
  reachable_->low = std::min(command_degC, reachable_->low + way_K);
  reachable_->high = std::max(command_degC, reachable_->high - way_K);

  const bool outside = plate_degC < reachable_->low - kTolerance_K || plate_degC > reachable_->high + kTolerance_K;
  outside_s_ = outside ? outside_s_ + dt_s : 0;
  short_s_ = std::max(0.0, short_s_ - dt_s);
  if (outside_s_ >= kPatience_s) {
    const bool on_neutral_side = (plate_degC - command_degC) * (neutral_degC - command_degC) >= 0;
    if (limited && on_neutral_side)
      short_s_ = kShort_s;
    else
      failed_ = true;
  }
  return failed_ ? Result::kFailed : short_s_ > 0 ? Result::kShort : Result::kFollows;
}

}  // namespace tactus::thermal
