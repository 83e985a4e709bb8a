// Selects the step of the quality ladder for the next picture: the value of the setting, or by the time used. Pure.
#pragma once

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
