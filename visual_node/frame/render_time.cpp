#include "visual_node/frame/render_time.h"

#include <algorithm>

namespace tactus::visual {

void RenderTime::add(sync::Nanoseconds taken) {
  taken_[next_] = taken;
  next_ = (next_ + 1) % kFrames;
}

sync::Nanoseconds RenderTime::expected() const {
  auto sorted = taken_;
  std::nth_element(sorted.begin(), sorted.begin() + kFrames / 2, sorted.end());
  return sorted[kFrames / 2];
}

sync::Nanoseconds RenderTime::second_longest() const {
  auto sorted = taken_;
  std::nth_element(sorted.begin(), sorted.end() - 2, sorted.end());
  return sorted[kFrames - 2];
}

}  // namespace tactus::visual
