// Assigns frames to the slots of a video, and decides when its media clock is published. Pure.
#pragma once

#include <cstdint>
#include <optional>

namespace tactus::visual {

// A video has one slot per period of the loop, from its first frame on. A slot whose frame was missed, or dropped
// before the encoder, repeats the previous frame.
class SlotFiller {
 public:
  // How often the previous frame is repeated before the frame of this tick is written; nothing when the slot is
  // already filled. tick: number of the period, missed ones included.
  std::optional<std::int64_t> repeats_before(std::int64_t tick);
  std::int64_t written() const { return next_; }

 private:
  std::optional<std::int64_t> first_;
  std::int64_t next_ = 0;  // next slot to fill
};

// The pair (index in the file, host time) of every frame, so that no time must be interpolated.
class SlotClock {
 public:
  struct Pair {
    std::int64_t index;
    std::int8_t reason;  // media_clock_t: START, UNDERFLOW after a missed slot, else PERIODIC
  };
  // Call for every frame that is sent to the encoder.
  Pair frame(std::int64_t tick);

 private:
  std::optional<std::int64_t> first_;
  std::int64_t last_ = 0;
};

}  // namespace tactus::visual
