// The part of a log that a table holds. Pure.
#pragma once

#include <cstdint>

#include "sync/log/log_origin.h"

namespace tactus::sync {

// Both ends belong to it, in s since the live part of the log began; by default the whole log.
struct LogInterval {
  double since_s = -1e18, until_s = 1e18;

  // live_ns: time since the live part of the log began, ns.
  bool contains(std::int64_t live_ns) const {
    const double t_s = static_cast<double>(live_ns) / 1e9;  // as its decimal number in the table reads
    return t_s >= since_s && t_s <= until_s;
  }
  // arrival: time at which the recorder received a message.
  bool contains(const LogOrigin& origin, HostTime arrival) const { return contains(to_ns(arrival) - origin.info.live_from_ns); }
};

}  // namespace tactus::sync
