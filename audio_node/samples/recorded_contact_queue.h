// The loop side of the queue of contacts that play recordings. Pure.
#pragma once

#include <cstdint>
#include <deque>

#include "audio_node/samples/shot.h"
#include "audio_node/signal/spsc.h"

namespace tactus::audio {

// Used on the loop thread.
class RecordedContactQueue {
 public:
  explicit RecordedContactQueue(Spsc<RecordedContact>& queue) : queue_(queue) {}

  // False when the queue is full: a state is skipped and counted as lost; an end is sent as soon as there is room,
  // unless its contact continues.
  bool submit(const RecordedContact& contact);
  // Call once per tick.
  void send_ends();
  std::int64_t lost() const { return lost_; }

 private:
  Spsc<RecordedContact>& queue_;
  std::deque<RecordedContact> pending_ends_;  // ends that have not been sent
  std::int64_t lost_ = 0;
};

}  // namespace tactus::audio
