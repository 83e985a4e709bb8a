#include "visual_node/frame/room_delay.h"

#include <algorithm>

namespace tactus::visual {

void RoomDelay::request(RoomTime sent, sync::Nanoseconds delay) {
  const sync::Nanoseconds before = requests_.empty() ? target_.delay : requests_.back().delay;
  if (delay == before || sent <= (requests_.empty() ? target_.sent : requests_.back().sent)) return;
  if (requests_.size() < kMaxRequests) requests_.push_back({sent, delay});
}

sync::Nanoseconds RoomDelay::value(RoomTime t) const {
  const double passed_s = std::clamp(sync::to_seconds(t - target_.sent), 0.0, 1e6);
  const sync::Nanoseconds max_change = sync::from_seconds(passed_s * sync::PlayoutFollower::kSlew);
  return from_ + std::clamp(target_.delay - from_, -max_change, max_change);
}

sync::Nanoseconds RoomDelay::at(RoomTime t, RoomTime by) {
  for (; !requests_.empty() && requests_.front().sent <= by; requests_.pop_front()) {
    from_ = value(requests_.front().sent);
    target_ = requests_.front();
  }
  return value(t);
}

}  // namespace tactus::visual
