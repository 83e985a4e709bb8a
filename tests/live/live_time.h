// Times of the tests of the live server.
#pragma once

#include "sync/time/time.h"

namespace tactus::test {

// s seconds after the start of a server.
inline sync::HostTime at(double s) { return sync::host_time(10'000'000'000) + sync::from_seconds(s); }

}  // namespace tactus::test
