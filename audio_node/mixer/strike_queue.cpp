#include "audio_node/mixer/strike_queue.h"

#include <utility>

namespace tactus::audio {

// A strike that does not fit keeps no table, so there are at most as many tables as strikes in the callback.
bool StrikeQueue::submit(Strike strike, const Table& table) {
  const bool another = table != now_;
  strike.scene = another ? scene_ + 1 : scene_;
  if (!queues_.strikes.push(strike)) return false;
  if (!another) return true;
  if (now_) kept_.push_back({scene_, std::move(now_)});
  now_ = table;
  ++scene_;
  return true;
}

void StrikeQueue::free_released() {
  const std::int64_t oldest_held = queues_.oldest_held_scene.load(std::memory_order_acquire);
  while (!kept_.empty() && kept_.front().scene < oldest_held) kept_.pop_front();
}

}  // namespace tactus::audio
