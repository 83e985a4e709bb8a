// The time of a log: the stamps of its events, without damaged ones. Pure.
#pragma once

#include <optional>

#include "sync/time/time.h"

namespace tactus::sync {

class SummaryClock {
 public:
  // A larger step, or a step back, is accepted only when the next event confirms it.
  static constexpr Nanoseconds kLargestStep{60'000'000'000};

  HostTime observe(HostTime stamp) {
    if (!now_ || near(*now_, stamp) || (doubted_ && near(*doubted_, stamp))) {
      now_ = stamp;
      doubted_.reset();
    } else {
      doubted_ = stamp;
    }
    return *now_;
  }

 private:
  static bool near(HostTime before, HostTime t) { return t >= before && t - before <= kLargestStep; }
  std::optional<HostTime> now_, doubted_;
};

}  // namespace tactus::sync
