// The quality ladder of thermal_node: longer substeps of the skin model when a tick takes more than half of its
// period. Pure.
#pragma once

#include <array>

#include "sync/node/quality.h"
#include "thermal_node/settings.gen.h"
#include "thermal_node/skin/skin.h"

namespace tactus::thermal {

class Quality {
 public:
  // Each step halves the work of a tick of 20 ms. The last is 0.15 K off in the tick in which a touch on copper at
  // room temperature begins, and within 1 % of its change from the next tick on.
  static constexpr std::array<double, 3> kLongestSubsteps_s{Skin::kLongestSubstep_s, 0.010, 0.020};

  explicit Quality(const Settings& settings);

  // Call once per tick with its duration.
  void add(sync::Nanoseconds used) {
    if (fixed_step_ < 0) ladder_.add(used);
  }
  int step() const { return fixed_step_ < 0 ? ladder_.step() : fixed_step_; }
  static constexpr int steps() { return static_cast<int>(kLongestSubsteps_s.size()); }
  double longest_substep_s() const { return kLongestSubsteps_s[static_cast<std::size_t>(step())]; }

 private:
  sync::QualityLadder ladder_;
  int fixed_step_;  // step fixed by the setting; -1: chosen from the tick times
};

}  // namespace tactus::thermal
