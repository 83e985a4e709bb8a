// Generations of requests that replace each other: the profile, and the playout policy. The largest holds.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tactus {

// A message with a larger one is refused, so that a successor always has a number. CLOCK_REALTIME in ns reaches it in 2116.
inline constexpr std::int64_t kMaxGeneration = std::int64_t{1} << 62;

// Of a new request. newest: of the newest one that is known, from any sender: the request replaces it, also when the clock of that
// sender ran ahead or the own clock was set back. realtime_ns: CLOCK_REALTIME.
inline std::int64_t next_generation(std::int64_t newest, std::int64_t realtime_ns) {
  return std::clamp(realtime_ns, std::min(newest, kMaxGeneration - 1) + 1, kMaxGeneration);
}

}  // namespace tactus
