// The loop side of the queue of strikes to the callback. It numbers the scenes, and keeps the modes of the bodies of
// a scene until the callback has released all strikes of that scene. Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "audio_node/mixer/renderer.h"

namespace tactus::audio {

// Used on the loop thread. The callback never waits for it, and frees nothing.
class StrikeQueue {
 public:
  using Table = std::shared_ptr<const ResonatorTable>;

  explicit StrikeQueue(CallbackQueues& queues) : queues_(queues) {}

  // table: the sides of the strike point into it; null: they point to modes that are never freed. False when the
  // queue is full.
  bool submit(Strike strike, const Table& table);
  // Call once per tick: frees the tables of earlier scenes that the callback no longer reads.
  void free_released();
  // Number of tables of earlier scenes; at most one for each strike that the callback holds.
  std::size_t kept() const { return kept_.size(); }

 private:
  struct Kept {
    std::int64_t scene;
    Table table;
  };

  CallbackQueues& queues_;
  std::int64_t scene_ = 0;  // number of the scene of the newest strike
  Table now_;
  std::deque<Kept> kept_;
};

}  // namespace tactus::audio
