// Which side of a relay a sender lives on. What came over a line is never sent over one again, and what comes back
// is not let in: several relays in one site, a line that is there twice, or a network that carries both sites'
// multicast make no circles. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <tactus/header_t.hpp>
#include <utility>

#include "sync/time/time.h"

namespace tactus::sync {

class Sides {
 public:
  static constexpr int kHere = 0;  // the bus of this site; other sites count from 1
  // Silent for so long, a sender may turn up elsewhere.
  static constexpr Nanoseconds kForgotten{10'000'000'000};
  // As sync/bus/sequence.h for one channel; more are of false messages, and those not heard for longest go.
  static constexpr std::size_t kMax = 4096;

  // Whether this sender lives there: it does where it was heard first.
  bool lives(const header_t& h, int side, HostTime now);
  // Messages that came from where their sender does not live.
  std::int64_t echoes() const { return echoes_; }

 private:
  struct Sender {
    int side;
    HostTime heard;
  };
  std::map<std::pair<std::int32_t, std::int64_t>, Sender> senders_;  // by source and incarnation
  std::int64_t echoes_ = 0;
};

}  // namespace tactus::sync
