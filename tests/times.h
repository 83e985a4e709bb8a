// Times for the tests of all folders.
#pragma once

#include <cstdint>

#include "sync/time/time.h"

namespace tactus::test {

inline constexpr std::int64_t kMs = 1'000'000, kSecond = 1'000'000'000;  // ns
inline constexpr sync::Nanoseconds kMillisecond{kMs};

// t milliseconds after the zero of a clock.
inline sync::HostTime at_ms(std::int64_t t) { return sync::host_time(t * kMs); }

}  // namespace tactus::test
