// When the slow state is taken and which of its pages go out in a tick: two lanes, the world and the contacts, that share
// a budget of pages a second. A snapshot of a lane is taken when its time has come and the one before is out; its pages
// are spread over the ticks up to the next; when there is more than the budget carries, the lanes take turns and their
// rates fall. Pure.
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

  // A tick of the world begins.
  void tick(sync::SimTime now);
  // True when a snapshot of the lane is to be taken in this tick. Snapshot n is due at tick ceil(n * ticks per
  // snapshot), 16 or 17 at 60 Hz.
  bool due(Lane lane) const;
  // True when all pages of the lane are out.
  bool free(Lane lane) const { return at(lane).left() == 0; }
  // A page more than those of the snapshots, before all of them: true when the budget carries it now.
  bool take_extra();
  // It has been taken and has so many pages.
  void begin(Lane lane, std::size_t pages);
  // Somebody waits for the whole world: these pages replace what is left of the world's and go before all others.
  void begin_urgent_world(std::size_t pages);

  // The lane whose next page goes out now; kNone when the tick has sent its share.
  Lane next();

  // Snapshots a second of the lane, by the time between the last two.
  double rate_Hz(Lane lane) const { return at(lane).rate_Hz; }

 private:
  struct State {
    std::size_t pages = 0, sent = 0;
    std::size_t share = 0;  // pages that may still go out in this tick
    std::int64_t next = 0;  // number of the next snapshot
    std::int64_t taken_ns = -1;
    double rate_Hz = 0;
    std::size_t left() const { return pages - sent; }
  };
  State& at(Lane lane) { return lanes_[static_cast<std::size_t>(lane)]; }
  const State& at(Lane lane) const { return lanes_[static_cast<std::size_t>(lane)]; }
  void set_share(State& s) const;

  double rate_Hz_;
  double per_tick_;  // pages of the budget
  sync::Nanoseconds step_;
  std::array<State, 2> lanes_;
  bool urgent_ = false;
  Lane last_ = Lane::kContacts;
  double allowance_ = 0;  // pages that the budget allows now
  sync::SimTime now_{};
};

}  // namespace tactus::sim
