// Selects the ticks that show a new picture when a profile requests fewer pictures than ticks; the last picture is
// held in between. Pure.
#pragma once

#include "sync/time/time.h"

namespace tactus::visual {

class PictureRate {
 public:
  // Call once a tick. rate_Hz: requested pictures a second; 0: one in each of the loop's tick_Hz ticks a second.
  bool due(sync::HostTime now, double rate_Hz, double tick_Hz);
  // How long each picture is held; 0: for the tick.
  sync::Nanoseconds held() const { return held_; }
  // The next tick shows a new picture.
  void restart() { held_ = sync::Nanoseconds(0); }

 private:
  sync::Nanoseconds held_{0};
  sync::HostTime next_{};  // undefined while nothing is held
};

}  // namespace tactus::visual
