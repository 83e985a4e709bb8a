// The quality ladder of haptic_node. The time of a tick increases with the number of planes; when a tick takes
// more than half of its period, fewer planes are considered. Pure.
#pragma once

#include <array>

#include "haptic_node/settings.gen.h"
#include "haptic_node/contact/surfaces.h"
#include "sync/node/quality.h"

namespace tactus::haptic {

class Quality {
 public:
  // Planes at each step: those under pressure, then the nearest. At most three planes bind a point, so a corner
  // still holds at the last step.
  static constexpr std::array<std::size_t, 3> kPlanes{Surfaces::kMaxPresent, 5, 3};

  explicit Quality(const Settings& settings);

  // Call once per tick with its duration.
  void add(sync::Nanoseconds used);
  int step() const { return fixed_step_ < 0 ? ladder_.step() : fixed_step_; }
  static constexpr int steps() { return static_cast<int>(kPlanes.size()); }
  std::size_t planes() const { return kPlanes[static_cast<std::size_t>(step())]; }

 private:
  sync::QualityLadder ladder_;
  int ticks_per_mean_;  // ticks per mean that the ladder receives
  int ticks_ = 0;
  sync::Nanoseconds used_{0};
  int fixed_step_;  // step fixed by the setting; -1: chosen from the tick times
};

}  // namespace tactus::haptic
