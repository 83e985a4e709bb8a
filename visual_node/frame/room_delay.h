// The presentation delay at an instant of the room's clock, as PLAYOUT requests it. It slews as in the other
// modalities, but from the send time of the request and not from its arrival, so that all walls have the same
// delay. Pure.
#pragma once

#include <cstddef>
#include <deque>

#include "sync/playout/follower.h"
#include "visual_node/frame/room_time.h"

namespace tactus::visual {

class RoomDelay {
 public:
  // PLAYOUT is sent at 10 Hz: the requests of the last second or two.
  static constexpr std::size_t kMaxRequests = 16;

  // Requests `delay` from `sent` on.
  void request(RoomTime sent, sync::Nanoseconds delay);
  // The delay of the frame that is due at t. Requests after `by` count for later frames. `by` must not decrease
  // from call to call.
  sync::Nanoseconds at(RoomTime t, RoomTime by);
  void restart() { *this = {}; }

 private:
  struct Request {
    RoomTime sent;
    sync::Nanoseconds delay;
  };
  sync::Nanoseconds value(RoomTime t) const;

  std::deque<Request> requests_;  // pending, in order of time
  Request target_{};              // in force
  sync::Nanoseconds from_{0};     // the delay at the start of target_
};

}  // namespace tactus::visual
