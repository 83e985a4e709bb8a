// What is known of other clocks: the published maps of this run, and how a time of one clock reads on another. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <tactus/clock_map_t.hpp>
#include <utility>

#include "sync/time/time.h"

namespace tactus::sync {

// An instant on the clock asked for, and the half width of the interval that surely holds it.
struct ClockReading {
  HostTime time{};
  Nanoseconds uncertainty{0};
};

// One clock as a line in another.
class ClockLine {
 public:
  explicit ClockLine(const clock_map_t& m);
  ClockReading from_of(HostTime of) const;  // reads a time of of_clock on to_clock
  ClockReading to_of(HostTime to) const;    // and back

 private:
  Nanoseconds uncertainty_at(Nanoseconds since) const;
  HostTime at_;
  Nanoseconds offset_;
  double drift_;
  Nanoseconds uncertainty_;
  double uncertainty_drift_;
};

class ClockMaps {
 public:
  // A map that nobody renews grows less certain; beyond this the one-way estimate is no worse, whose bias is a latency
  // (design: one frame at 60 Hz).
  static constexpr Nanoseconds kMaxUncertain{16'000'000};
  // Of two publishers of one map the first is heeded until it has been silent for four of its periods.
  static constexpr Nanoseconds kSilence{2'000'000'000};
  // More clocks than a cluster has hosts: beyond this, maps are an attack or a mistake.
  static constexpr std::size_t kMax = 1024;

  // Maps of another run speak of clocks as they were: ignored and counted. Run 0: that of the first map.
  explicit ClockMaps(std::int64_t run_id) : run_id_(run_id) {}

  void observe(const clock_map_t&, HostTime arrival);
  // Nothing when no map leads from one to the other, or none that is certain enough.
  std::optional<ClockReading> read(HostTime time, std::int32_t of_clock, std::int32_t on_clock) const;
  std::int64_t foreign() const { return foreign_; }
  std::int64_t run_id() const { return run_id_; }

 private:
  struct Known {
    clock_map_t map;
    HostTime arrival;
  };
  std::int64_t run_id_;
  std::map<std::pair<std::int32_t, std::int32_t>, Known> known_;  // by of_clock, to_clock
  std::int64_t foreign_ = 0;
};

// Whose clock is ours, and what is known of others. A bare run id says: all of this run share one clock.
struct OwnClock {
  OwnClock(std::int64_t run, std::int32_t clock_id = 0, const ClockMaps* known = nullptr)
      : run_id(run), clock(clock_id), maps(known) {}
  std::int64_t run_id;
  std::int32_t clock;
  const ClockMaps* maps;  // outlives this; null: there are none
};

}  // namespace tactus::sync
