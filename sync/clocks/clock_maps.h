// The published clock maps of this run, and the conversion of a time from one clock to another. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "sync/time/time.h"

namespace tactus {
class clock_map_t;
}

namespace tactus::sync {

// An instant on the requested clock, and the half width of the interval that certainly contains it.
struct ClockReading {
  HostTime time{};
  Nanoseconds uncertainty{0};
};

// The linear map between two clocks.
class ClockLine {
 public:
  explicit ClockLine(const clock_map_t& m);
  ClockReading of_to_target(HostTime of) const;  // converts a time of of_clock to to_clock
  ClockReading target_to_of(HostTime to) const;    // the inverse

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
  // The uncertainty of a map grows until the map is renewed. Beyond this value the one-way estimate is at least as good; its bias is
  // a latency (design: one frame at 60 Hz).
  static constexpr Nanoseconds kMaxUncertainty{16'000'000};
  // When two processes publish one map, the first is used until it has been silent for four of its periods.
  static constexpr Nanoseconds kTimeout{2'000'000'000};
  // More clocks than a cluster has hosts: more maps can only come from an attack or a mistake.
  static constexpr std::size_t kMax = 1024;

  // Maps of another run describe other clocks: they are ignored and counted. Run 0: the run of the first map.
  explicit ClockMaps(std::int64_t run_id) : run_id_(run_id) {}

  void observe(const clock_map_t&, HostTime arrival);
  // nullopt when no sufficiently certain map connects the two clocks.
  std::optional<ClockReading> read(HostTime time, std::int32_t of_clock, std::int32_t on_clock) const;
  std::int64_t foreign() const { return foreign_; }
  std::int64_t run_id() const { return run_id_; }

 private:
  struct Known {
    ClockLine line;
    std::int32_t source;  // the publisher, from the header of the newest message
    std::int64_t incarnation, seq;
    HostTime arrival;
  };
  std::int64_t run_id_;
  std::map<std::pair<std::int32_t, std::int32_t>, Known> known_;  // by of_clock, to_clock
  std::int64_t foreign_ = 0;
};

// The clock of this process, and the maps of others. A bare run id means that all processes of the run share one clock.
struct OwnClock {
  OwnClock(std::int64_t run, std::int32_t clock_id = 0, const ClockMaps* known = nullptr)
      : run_id(run), clock(clock_id), maps(known) {}
  std::int64_t run_id;
  std::int32_t clock;
  const ClockMaps* maps;  // outlives this; null: there are none
};

}  // namespace tactus::sync
