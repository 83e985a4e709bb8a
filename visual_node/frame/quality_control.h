// Selects the step of the quality ladder for the next picture: the value of the setting, or by the time used. Pure.
#pragma once

#include <span>
#include <string>

#include "sync/node/quality.h"
#include "visual_node/scene_view/quality.h"
#include "visual_node/settings.gen.h"

namespace tactus::visual {

class QualityControl {
 public:
  explicit QualityControl(const Settings& settings);

  int step() const { return pinned_ >= 0 ? pinned_ : ladder_.step(); }
  static constexpr int steps() { return static_cast<int>(kQualities.size()); }
  const Quality& quality() const { return kQualities[static_cast<std::size_t>(step())]; }

  // Selects the first step by the measured times of pictures at the steps 0, 1, ..., unless the setting pins it.
  void start(std::span<const sync::Nanoseconds> costs) { ladder_.start(costs); }
  // True when a picture of this time makes a step too slow.
  bool too_long(sync::Nanoseconds used) const { return ladder_.too_long(used); }
  // Adds the time for which a picture of that step kept the loop busy.
  void add(sync::Nanoseconds used) { ladder_.add(used); }
  // One sentence when the step has changed since the last call, else empty.
  std::string take_change();

 private:
  int pinned_;  // -1: by time
  sync::QualityLadder ladder_;
  int reported_ = 0;
};

}  // namespace tactus::visual
