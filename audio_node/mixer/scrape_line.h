// The loop's end of the queue of scrapes into the callback: it numbers them, and keeps the surfaces that they
// point into until the callback has said that it holds none of them any more. Pure.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "audio_node/excitation/heard_surfaces.h"
#include "audio_node/mixer/renderer.h"

namespace tactus::audio {

// Of the loop's thread. The callback never waits for it, and frees nothing.
class ScrapeLine {
 public:
  using Surfaces = std::shared_ptr<const HeardSurfaces>;

  explicit ScrapeLine(CallbackQueues& crossing) : crossing_(crossing) {}

  // Scrapes that are submitted from now on point into these; null: into none. Those of before are kept while the
  // callback may read them. While it stands still no more than the queue holds scrapes.
  void change(Surfaces next);
  // False when the queue is full: a state is not heard, and counted as lost; an end is told as soon as there is
  // room, unless its contact goes on.
  bool submit(Scrape scrape);
  // Once a tick.
  void tell_ends();
  std::int64_t lost() const { return lost_; }
  // Those of before that nobody reads any more. Freeing them may take milliseconds: not in a loop.
  std::vector<Surfaces> take_unread();

 private:
  struct Kept {
    std::int64_t end;  // number after that of its last scrape
    Surfaces surfaces;
  };
  bool push(Scrape& scrape);

  CallbackQueues& crossing_;
  std::deque<std::int64_t> owed_;  // contacts whose end has not been told
  std::int64_t lost_ = 0;
  std::int64_t submitted_ = 0, first_ = 0;  // scrapes so far; number of the first into `now_`
  Surfaces now_;
  std::deque<Kept> kept_;
};

}  // namespace tactus::audio
