#include "sync/bus/inbox.h"

#include <algorithm>

namespace tactus::sync {

InputAge age_of(const InputCount& in, const OwnClock& own, HostTime now) {
  if (in.newest_publish_ns < 0) return {};
  const HostTime sent = host_time(in.newest_publish_ns);
  const bool ours = in.newest_run_id == own.run_id;
  if (ours && in.newest_clock == own.clock) return {std::max(now - sent, Nanoseconds(0)), Nanoseconds(0)};
  if (ours && own.maps != nullptr)
    if (const auto mapped = own.maps->read(sent, in.newest_clock, own.clock))
      return {std::max(now - mapped->time, Nanoseconds(0)), mapped->uncertainty};
  return {now - in.newest_arrival, Nanoseconds(-1)};
}

}  // namespace tactus::sync
