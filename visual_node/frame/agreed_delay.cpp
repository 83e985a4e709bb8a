#include "visual_node/frame/agreed_delay.h"

#include <algorithm>

namespace tactus::visual {

void AgreedDelay::ask(RoomTime sent, sync::Nanoseconds delay) {
  const sync::Nanoseconds before = asked_.empty() ? target_.delay : asked_.back().delay;
  if (delay == before || sent <= (asked_.empty() ? target_.sent : asked_.back().sent)) return;
  if (asked_.size() < kAsked) asked_.push_back({sent, delay});
}

sync::Nanoseconds AgreedDelay::value(RoomTime t) const {
  const double passed_s = std::clamp(sync::to_seconds(t - target_.sent), 0.0, 1e6);
  const sync::Nanoseconds most = sync::from_seconds(passed_s * sync::PlayoutFollower::kSlew);
  return from_ + std::clamp(target_.delay - from_, -most, most);
}

sync::Nanoseconds AgreedDelay::at(RoomTime t, RoomTime by) {
  for (; !asked_.empty() && asked_.front().sent <= by; asked_.pop_front()) {
    from_ = value(asked_.front().sent);
    target_ = asked_.front();
  }
  return value(t);
}

}  // namespace tactus::visual
