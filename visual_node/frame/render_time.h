// How long a frame takes from its tick to its fence, to foretell when the next one will be presented. Pure.
#pragma once

#include <array>
#include <cstddef>

#include "sync/time/time.h"

namespace tactus::visual {

// The median of the last frames: one that was held up, or a process that was stopped in the middle of one, does
// not move it.
class RenderTime {
 public:
  static constexpr std::size_t kFrames = 9;
  // Before the first frame: a software renderer's typical time.
  explicit RenderTime(sync::Nanoseconds first_guess = sync::Nanoseconds(8'000'000)) { taken_.fill(first_guess); }

  void add(sync::Nanoseconds taken);
  sync::Nanoseconds expected() const;
  // What nearly none of them took longer than: the second longest.
  sync::Nanoseconds second_longest() const;

 private:
  std::array<sync::Nanoseconds, kFrames> taken_;
  std::size_t next_ = 0;
};

}  // namespace tactus::visual
