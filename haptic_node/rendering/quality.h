// The quality ladder of touch: the time of a tick grows with the planes, so fewer of them are considered when a tick takes more than half of its time. Pure.
#pragma once

#include <array>

#include "haptic_node/settings.gen.h"
#include "haptic_node/contact/surfaces.h"
#include "sync/node/quality.h"

namespace tactus::haptic {

class Quality {
 public:
  // Planes at each step: those under pressure, then the nearest. Three are the most that bind a point, so a corner
  // holds at the last step too.
  static constexpr std::array<std::size_t, 3> kPlanes{Surfaces::kMaxPresent, 5, 3};

  explicit Quality(const Settings& settings);

  // Once a tick: what it took.
  void add(sync::Nanoseconds used);
  int step() const { return held_ < 0 ? ladder_.step() : held_; }
  static constexpr int steps() { return static_cast<int>(kPlanes.size()); }
  std::size_t planes() const { return kPlanes[static_cast<std::size_t>(step())]; }

 private:
  sync::QualityLadder ladder_;
  int together_;  // ticks, of which the ladder is told the mean
  int ticks_ = 0;
  sync::Nanoseconds used_{0};
  int held_;  // by the setting; -1: by the time that ticks take
};

}  // namespace tactus::haptic
