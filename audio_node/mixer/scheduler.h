// Holds strikes until their sample. Pure.
#pragma once

#include <vector>

#include "audio_node/excitation/strike.h"

namespace tactus::audio {

// A heap of fixed capacity, ordered by presentation time; equal times keep their order of arrival. Time is
// converted to a sample only when a block is rendered, since the map between the two is corrected continuously.
// Realtime-safe: yes, except the constructor.
class Scheduler {
 public:
  explicit Scheduler(int capacity);

  // False when it is full.
  bool push(const Strike& strike);
  // The earliest strike that is scheduled before `end`, or null. It stays valid until the next call.
  const Strike* pop_before(sync::HostTime end);
  // Waiting strikes, in no particular order.
  template <class F>
  void for_each(F f) const {
    for (const Entry& e : heap_) f(slots_[static_cast<std::size_t>(e.slot)]);
  }
  int size() const { return static_cast<int>(heap_.size()); }

 private:
  struct Entry {
    sync::HostTime scheduled;
    std::int64_t order;
    int slot;
  };
  static bool later(const Entry& a, const Entry& b) {
    return a.scheduled != b.scheduled ? a.scheduled > b.scheduled : a.order > b.order;
  }
  std::vector<Strike> slots_;
  std::vector<int> free_;
  std::vector<Entry> heap_;
  std::int64_t pushed_ = 0;
};

}  // namespace tactus::audio
