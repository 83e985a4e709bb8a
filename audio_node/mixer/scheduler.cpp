#include "audio_node/mixer/scheduler.h"

#include <algorithm>

namespace tactus::audio {

Scheduler::Scheduler(int capacity) : slots_(static_cast<std::size_t>(capacity)) {
  for (int i = capacity; i-- > 0;) free_.push_back(i);
  heap_.reserve(slots_.size());
}

bool Scheduler::push(const Strike& strike) {
  if (free_.empty()) return false;
  const int slot = free_.back();
  free_.pop_back();
  slots_[static_cast<std::size_t>(slot)] = strike;
  heap_.push_back({strike.scheduled, pushed_++, slot});
  std::push_heap(heap_.begin(), heap_.end(), later);
  return true;
}

const Strike* Scheduler::pop_before(sync::HostTime end) {
  if (heap_.empty() || heap_.front().scheduled >= end) return nullptr;
  std::pop_heap(heap_.begin(), heap_.end(), later);
  const int slot = heap_.back().slot;
  heap_.pop_back();
  free_.push_back(slot);
  return &slots_[static_cast<std::size_t>(slot)];
}

}  // namespace tactus::audio
