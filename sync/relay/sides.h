// The side of a relay that each sender belongs to. Messages from a line are never sent over a line again, and returning
// messages are rejected: several relays in one site, a duplicate line, or a network that carries both sites' multicast cause
// no loops. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <tactus/header_t.hpp>
#include <utility>

#include "sync/time/time.h"

namespace tactus::sync {

class SenderSides {
 public:
  static constexpr int kHere = 0;  // the bus of this site; other sites count from 1
  // After this silence a sender may appear on another side.
  static constexpr Nanoseconds kTimeout{10'000'000'000};
  // The same limit as in sync/bus/sequence.h for one channel. More senders can only come from corrupt messages; those that
  // have been silent for longest are removed.
  static constexpr std::size_t kMax = 4096;

  // True when this sender belongs to that side: the side where it was first received.
  bool belongs_to(const header_t& h, int side, HostTime now);

 private:
  struct Sender {
    int side;
    HostTime last_seen;
  };
  std::map<std::pair<std::int32_t, std::int64_t>, Sender> senders_;  // by source and incarnation
};

}  // namespace tactus::sync
