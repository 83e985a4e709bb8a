// The loop's end of the queue of contacts that play recordings. Pure.
#pragma once

#include <cstdint>
#include <deque>

#include "audio_node/samples/shot.h"
#include "audio_node/signal/spsc.h"

namespace tactus::audio {

// Of the loop's thread.
class RubLine {
 public:
  explicit RubLine(Spsc<RecordedContact>& queue) : queue_(queue) {}

  // False when the queue is full: a state is not heard, and counted as lost; an end is told as soon as there is
  // room, unless its contact goes on.
  bool submit(const RecordedContact& rub);
  // Once a tick.
  void tell_ends();
  std::int64_t lost() const { return lost_; }

 private:
  Spsc<RecordedContact>& queue_;
  std::deque<RecordedContact> owed_;  // ends that have not been told
  std::int64_t lost_ = 0;
};

}  // namespace tactus::audio
