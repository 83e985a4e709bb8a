// Drawing time of a frame from its tick to its fence; predicts the presentation of the next one. Pure.
#pragma once

#include <array>
#include <cstddef>

#include "sync/time/time.h"

namespace tactus::visual {

// Statistics of the last frames. The median ignores a single delayed frame, or a process that was stopped within
// one.
class RenderTime {
 public:
  static constexpr std::size_t kFrames = 9;
  // Before the first frame: a typical time of a software renderer.
  explicit RenderTime(sync::Nanoseconds first_guess = sync::Nanoseconds(8'000'000)) { taken_.fill(first_guess); }

  void add(sync::Nanoseconds taken);
  sync::Nanoseconds expected() const;
  // Upper bound of nearly all: the second longest.
  sync::Nanoseconds second_longest() const;

 private:
  std::array<sync::Nanoseconds, kFrames> taken_;
  std::size_t next_ = 0;
};

}  // namespace tactus::visual
