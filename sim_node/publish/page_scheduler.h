// Schedules the snapshots of the slow state and their pages: two lanes, world and contacts, share a budget of pages
// per second. A lane takes a snapshot when it is due and the previous one has been sent. Its pages are spread over
// the ticks up to the next one. When the budget is exceeded, the lanes alternate and their rates fall. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "sync/time/time.h"

namespace tactus::sim {

enum class Lane : std::size_t { kWorld = 0, kContacts = 1, kNone = 2 };

class PageScheduler {
 public:
  PageScheduler(double rate_Hz, double pages_per_second, sync::Nanoseconds step);

  // Call at the beginning of each tick.
  void tick(sync::SimTime now);
  // True when a snapshot of the lane must be taken in this tick. Snapshot n is due at tick ceil(n * ticks per
  // snapshot), 16 or 17 at 60 Hz.
  bool due(Lane lane) const;
  // True when all pages of the lane have been sent.
  bool free(Lane lane) const { return at(lane).left() == 0; }
  // Requests a page in addition to the snapshots and before them; true when the budget allows it.
  bool take_extra();
  // Call after taking a snapshot of this number of pages.
  void begin(Lane lane, std::size_t pages);
  // A receiver needs the whole world: these pages replace the remaining ones of the world and precede all others.
  void begin_urgent_world(std::size_t pages);

  // The lane whose next page must be sent now; kNone when the share of the tick has been sent.
  Lane next();

  // Snapshots per second of the lane, from the interval between the last two.
  double rate_Hz(Lane lane) const { return at(lane).rate_Hz; }

 private:
  struct State {
    std::size_t pages = 0, sent = 0;
    std::size_t share = 0;  // pages that may still be sent in this tick
    std::int64_t next = 0;  // number of the next snapshot
    std::int64_t taken_ns = -1;
    double rate_Hz = 0;
    std::size_t left() const { return pages - sent; }
  };
  State& at(Lane lane) { return lanes_[static_cast<std::size_t>(lane)]; }
  const State& at(Lane lane) const { return lanes_[static_cast<std::size_t>(lane)]; }
  void set_share(State& s) const;

  double rate_Hz_;
  double per_tick_;  // budget in pages per tick
  sync::Nanoseconds step_;
  std::array<State, 2> lanes_;
  bool urgent_ = false;
  Lane last_ = Lane::kContacts;
  double allowance_ = 0;  // pages that the budget allows now
  sync::SimTime now_{};
};

}  // namespace tactus::sim
