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

SlotClock::Pair SlotClock::frame(std::int64_t tick) {
  const bool start = !first_, missed = first_ && tick > last_ + 1;
  if (start) first_ = tick;
  last_ = tick;
  return {tick - *first_, start    ? media_clock_t::START
                          : missed ? media_clock_t::UNDERFLOW
                                   : media_clock_t::PERIODIC};
}

}  // namespace tactus::visual
