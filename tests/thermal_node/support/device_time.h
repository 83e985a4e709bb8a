// Times of the tests of thermal devices.
#pragma once

#include <cstdint>

#include "sync/time/time.h"

namespace tactus::thermal::test {

inline constexpr std::int32_t kClock = 77;  // of the host of the device

// ms after the start of the tests.
inline sync::HostTime at(std::int64_t ms) { return sync::host_time(1'000'000'000 + ms * 1'000'000); }

}  // namespace tactus::thermal::test
