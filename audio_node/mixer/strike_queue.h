// The loop's end of the queue of strikes into the callback: it numbers the scenes that they are of, and keeps the modes of
// the bodies of a scene until the callback holds no strike of that scene any more. Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "audio_node/mixer/renderer.h"

namespace tactus::audio {

// Of the loop's thread. The callback never waits for it, and frees nothing.
class StrikeQueue {
 public:
  using Table = std::shared_ptr<const ResonatorTable>;

  explicit StrikeQueue(CallbackQueues& queues) : queues_(queues) {}

  // table: the sides of the strike refer to it; null: to none that is ever freed. False when the queue is full.
  bool submit(Strike strike, const Table& table);
  // Once a tick: frees the tables of earlier scenes that the callback reads no more.
  void free_released();
  // Tables of earlier scenes that are kept; at most one for each strike that the callback holds.
  std::size_t kept() const { return kept_.size(); }

 private:
  struct Kept {
    std::int64_t scene;
    Table table;
  };

  CallbackQueues& queues_;
  std::int64_t scene_ = 0;  // number of the newest that a strike crossed of
  Table now_;
  std::deque<Kept> kept_;
};

}  // namespace tactus::audio
