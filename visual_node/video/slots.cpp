#include "visual_node/video/slots.h"

#include <tactus/media_clock_t.hpp>

namespace tactus::visual {

std::optional<std::int64_t> SlotFiller::repeats_before(std::int64_t tick) {
  if (!first_) first_ = tick;
  const std::int64_t slot = tick - *first_;
  if (slot < next_) return std::nullopt;
  const std::int64_t repeats = slot - next_;
  next_ = slot + 1;
  return repeats;
}

std::optional<SlotClock::Pair> SlotClock::frame(std::int64_t tick) {
  std::optional<Pair> pair;
  if (!first_) {
    first_ = tick;
    pair = Pair{0, media_clock_t::START};
  } else if (tick > last_ + 1) {
    pair = Pair{tick - *first_, media_clock_t::UNDERFLOW};
  } else if (tick - last_told_ >= per_second_) {
    pair = Pair{tick - *first_, media_clock_t::PERIODIC};
  }
  last_ = tick;
  if (pair) last_told_ = tick;
  return pair;
}

}  // namespace tactus::visual
