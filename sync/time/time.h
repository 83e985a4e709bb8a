// Host time and simulated time as two types that cannot be mixed: subtracting one from the other does not compile.
#pragma once

#include <chrono>
#include <cstdint>

namespace tactus::sync {

using Nanoseconds = std::chrono::nanoseconds;

// Tag: CLOCK_MONOTONIC of this host. Read it with host_now() in sync/clocks/pacing.h.
struct HostClock {
  using duration = Nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<HostClock, Nanoseconds>;
  static constexpr bool is_steady = true;
};

// Tag: the simulated world's time, from its beginning.
struct SimClock {
  using duration = Nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<SimClock, Nanoseconds>;
  static constexpr bool is_steady = true;
};

using HostTime = HostClock::time_point;
using SimTime = SimClock::time_point;

constexpr HostTime host_time(std::int64_t ns) { return HostTime(Nanoseconds(ns)); }
constexpr SimTime sim_time(std::int64_t ns) { return SimTime(Nanoseconds(ns)); }
template <class TimePoint>
constexpr std::int64_t to_ns(TimePoint t) {
  return t.time_since_epoch().count();
}
constexpr Nanoseconds from_seconds(double s) { return Nanoseconds(static_cast<std::int64_t>(s * 1e9)); }
constexpr double to_seconds(Nanoseconds t) { return static_cast<double>(t.count()) * 1e-9; }

// The map between simulated time and the host clock: two corresponding instants and a rate. rate = simulated seconds per host
// second; 0: paused, every host time maps to `sim`.
struct TimeMap {
  SimTime sim{};
  HostTime host{};
  double rate = 1;

  SimTime to_sim(HostTime t) const { return sim + scaled(t - host, rate); }
  // While paused, every instant of the world maps to the host time of the map.
  HostTime to_host(SimTime t) const { return rate > 0 ? host + scaled(t - sim, 1 / rate) : host; }

 private:
  static Nanoseconds scaled(Nanoseconds d, double factor) {
    if (factor == 1) return d;  // keeps whole nanoseconds exact
    const double ns = static_cast<double>(d.count()) * factor;
    constexpr double kMax = 3e18;  // 95 years: keeps values from corrupt messages from overflowing
    return Nanoseconds(static_cast<std::int64_t>(!(ns > -kMax) ? -kMax : ns < kMax ? ns : kMax));
  }
};

}  // namespace tactus::sync
