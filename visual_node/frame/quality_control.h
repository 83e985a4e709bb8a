// Which step of the quality ladder the next picture is drawn with: the setting's, or what the time allows. Pure.
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

  // A picture of that step kept the loop busy for so long.
  void add(sync::Nanoseconds used) { ladder_.add(used); }
  // One sentence for the reader when the step has changed since the last call, else empty.
  std::string take_change();

 private:
  int pinned_;  // -1: by time
  sync::QualityLadder ladder_;
  int said_ = 0;
};

}  // namespace tactus::visual
