// The loop side of the queue of scrapes to the callback. It numbers the scrapes, and keeps the surfaces that they
// point to until the callback has released all of them. Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "audio_node/excitation/audio_surfaces.h"
#include "audio_node/mixer/renderer.h"

namespace tactus::audio {

// Used on the loop thread. The callback never waits for it, and frees nothing.
class ScrapeQueue {
 public:
  using Surfaces = std::shared_ptr<const AudioSurfaces>;

  explicit ScrapeQueue(CallbackQueues& queues) : queues_(queues) {}

  // Later scrapes point to these surfaces; null: none. The previous surfaces are kept while the callback may read
  // them. While the callback is stopped, at most one queue of scrapes holds them.
  void set_surfaces(Surfaces next);
  // False when the queue is full: a state is skipped and counted as lost; an end is sent as soon as there is room,
  // unless its contact continues.
  bool submit(Scrape scrape);
  // Call once per tick.
  void send_ends();
  std::int64_t lost() const { return lost_; }
  // Returns previous surfaces that are no longer read. Freeing them may take milliseconds, so do not free them in
  // the loop.
  std::vector<Surfaces> take_released();

 private:
  struct Kept {
    std::int64_t end;  // number after that of its last scrape
    Surfaces surfaces;
  };
  bool push(Scrape& scrape);

  CallbackQueues& queues_;
  std::deque<std::int64_t> pending_ends_;  // contacts whose end has not been sent
  std::int64_t lost_ = 0;
  std::int64_t submitted_ = 0, first_ = 0;  // number of scrapes; number of the first one of `now_`
  Surfaces now_;
  std::deque<Kept> kept_;
};

}  // namespace tactus::audio
