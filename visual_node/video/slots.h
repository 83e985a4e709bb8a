// Which frame fills which slot of a video, and when its clock is told. Pure.
#pragma once

#include <cstdint>
#include <optional>

namespace tactus::visual {

// A video has one slot per period of the loop, from its first frame on. A slot whose frame was missed, or dropped
// on the way to the encoder, repeats the frame before.
class SlotFiller {
 public:
  // How often the frame before is to be repeated before the frame of this tick is written; nothing when the slot
  // is filled already. tick: number of the period, counting missed ones too.
  std::optional<std::int64_t> repeats_before(std::int64_t tick);
  std::int64_t written() const { return next_; }

 private:
  std::optional<std::int64_t> first_;
  std::int64_t next_ = 0;  // slot to be filled next
};

// The pair (index in the file, host time) of every frame: between two of them nobody need guess.
class SlotClock {
 public:
  struct Pair {
    std::int64_t index;
    std::int8_t reason;  // media_clock_t: START, UNDERFLOW after a missed slot, else PERIODIC
  };
  // Call for every frame that goes to the encoder.
  Pair frame(std::int64_t tick);

 private:
  std::optional<std::int64_t> first_;
  std::int64_t last_ = 0;
};

}  // namespace tactus::visual
