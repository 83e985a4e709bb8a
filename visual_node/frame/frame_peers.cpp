#include "visual_node/frame/frame_peers.h"

#include <algorithm>

namespace tactus::visual {

void FramePeers::on_message(const frame_shown_t& m, std::int64_t own, sync::HostTime arrival) {
  if (m.header.incarnation == own) return;
  std::erase_if(walls_, [&](const auto& w) { return arrival - w.second.last_message > kTimeout; });
  if (!walls_.contains(m.header.incarnation) && walls_.size() >= kMax) return;
  Wall& wall = walls_[m.header.incarnation];
  wall.last_message = arrival;
  wall.drawn = m.frame;  // not the largest: with another clock the numbers start low again
}

bool FramePeers::ready(std::int64_t frame, sync::HostTime now) const {
  return std::all_of(walls_.begin(), walls_.end(), [&](const auto& w) {
    return w.second.ignored || now - w.second.last_message > kTimeout || w.second.drawn >= frame;
  });
}

void FramePeers::shown(std::int64_t frame, sync::HostTime now) {
  for (auto& [incarnation, wall] : walls_) {
    const bool in_time = wall.drawn >= frame || now - wall.last_message > kTimeout;
    if (wall.ignored) {
      wall.in_time = in_time ? wall.in_time + 1 : 0;
      if (wall.in_time >= kFramesToReturn) wall.ignored = false, wall.late = 0;
    } else {
      wall.late = in_time ? std::max(0, wall.late - 1) : wall.late + 1;
      if (wall.late >= kMaxLateFrames) wall.ignored = true, wall.in_time = 0;
    }
  }
}

int FramePeers::present(sync::HostTime now) const {
  return static_cast<int>(std::count_if(walls_.begin(), walls_.end(),
                                        [&](const auto& w) { return now - w.second.last_message <= kTimeout; }));
}

int FramePeers::ignored(sync::HostTime now) const {
  return static_cast<int>(std::count_if(walls_.begin(), walls_.end(), [&](const auto& w) {
    return w.second.ignored && now - w.second.last_message <= kTimeout;
  }));
}

}  // namespace tactus::visual
