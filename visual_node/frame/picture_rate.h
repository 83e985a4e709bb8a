// Which ticks show a new picture when a profile asks for fewer than the loop has; in between the last is held.
// Pure.
#pragma once

#include "sync/time/time.h"

namespace tactus::visual {

class PictureRate {
 public:
  // Once a tick. rate_Hz: pictures a second asked for; 0: one in each of the loop's tick_Hz ticks a second.
  bool due(sync::HostTime now, double rate_Hz, double tick_Hz);
  // For how long each picture is held; 0: for the tick.
  sync::Nanoseconds held() const { return held_; }
  // The next tick shows a new picture.
  void restart() { held_ = sync::Nanoseconds(0); }

 private:
  sync::Nanoseconds held_{0};
  sync::HostTime next_{};  // of no meaning while nothing is held
};

}  // namespace tactus::visual
