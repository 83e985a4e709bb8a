#include "visual_node/frame/picture_rate.h"

namespace tactus::visual {

bool PictureRate::due(sync::HostTime now, double rate_Hz, double tick_Hz) {
  const bool held = held_ > sync::Nanoseconds(0);
  held_ = rate_Hz > 0 && rate_Hz < tick_Hz ? sync::from_seconds(1 / rate_Hz) : sync::Nanoseconds(0);
  if (held_ == sync::Nanoseconds(0)) return true;
  // Also when the rate has increased since.
  if (!held || next_ - now > held_) next_ = now;
  // Use the nearest tick: ticks come some milliseconds early or late.
  if (now + sync::from_seconds(0.5 / tick_Hz) < next_) return false;
  next_ += held_;
  if (next_ <= now) next_ = now + held_;  // after a stall one picture, not many in a row
  return true;
}

}  // namespace tactus::visual
