// The time of a log: the stamps of its events, without damaged ones. Pure.
#pragma once

#include <optional>

#include "sync/time/time.h"

namespace tactus::sync {

class SummaryClock {
 public:
  // A larger step, or a step back, is accepted only when the next event confirms it.
  static constexpr Nanoseconds kMaxStep{60'000'000'000};

  HostTime observe(HostTime stamp) {
    if (!now_ || near(*now_, stamp) || (unconfirmed_ && near(*unconfirmed_, stamp))) {
      now_ = stamp;
      unconfirmed_.reset();
    } else {
      unconfirmed_ = stamp;
    }
    return *now_;
  }

 private:
  static bool near(HostTime before, HostTime t) { return t >= before && t - before <= kMaxStep; }
  std::optional<HostTime> now_, unconfirmed_;
};

}  // namespace tactus::sync
