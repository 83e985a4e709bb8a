// The presentation delay at an instant of the room's clock, from what PLAYOUT asks for: slewed as a sense does it,
// but by when it was asked for and not by when it was heard, so that all walls have it alike. Pure.
#pragma once

#include <cstddef>
#include <deque>

#include "sync/playout/follower.h"
#include "visual_node/frame/room_time.h"

namespace tactus::visual {

class AgreedDelay {
 public:
  // PLAYOUT comes ten times a second: what is asked for in the last second or two.
  static constexpr std::size_t kAsked = 16;

  // Asked for at `sent`, from there on.
  void ask(RoomTime sent, sync::Nanoseconds delay);
  // Of the frame that is due at t; what was asked for after `by` is of later frames. Call with ever later `by`.
  sync::Nanoseconds at(RoomTime t, RoomTime by);
  void restart() { *this = {}; }

 private:
  struct Asked {
    RoomTime sent;
    sync::Nanoseconds delay;
  };
  sync::Nanoseconds value(RoomTime t) const;

  std::deque<Asked> asked_;    // not in force yet, in order of time
  Asked target_{};             // in force
  sync::Nanoseconds from_{0};  // the delay when it came into force
};

}  // namespace tactus::visual
