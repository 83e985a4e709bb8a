#include "visual_node/frame/frame_peers.h"

#include <algorithm>

namespace tactus::visual {

void FramePeers::hear(const frame_shown_t& m, std::int64_t own, sync::HostTime arrival) {
  if (m.header.incarnation == own) return;
  std::erase_if(walls_, [&](const auto& w) { return arrival - w.second.heard > kGone; });
  if (!walls_.contains(m.header.incarnation) && walls_.size() >= kMax) return;
  Wall& wall = walls_[m.header.incarnation];
  wall.heard = arrival;
  wall.drawn = m.frame;  // not the largest: after another clock has come they are small again
}

bool FramePeers::ready(std::int64_t frame, sync::HostTime now) const {
  return std::all_of(walls_.begin(), walls_.end(), [&](const auto& w) {
    return w.second.given_up || now - w.second.heard > kGone || w.second.drawn >= frame;
  });
}

void FramePeers::shown(std::int64_t frame, sync::HostTime now) {
  for (auto& [incarnation, wall] : walls_) {
    const bool in_time = wall.drawn >= frame || now - wall.heard > kGone;
    if (wall.given_up) {
      wall.in_time = in_time ? wall.in_time + 1 : 0;
      if (wall.in_time >= kReturn) wall.given_up = false, wall.late = 0;
    } else {
      wall.late = in_time ? std::max(0, wall.late - 1) : wall.late + 1;
      if (wall.late >= kGiveUp) wall.given_up = true, wall.in_time = 0;
    }
  }
}

int FramePeers::present(sync::HostTime now) const {
  return static_cast<int>(
      std::count_if(walls_.begin(), walls_.end(), [&](const auto& w) { return now - w.second.heard <= kGone; }));
}

int FramePeers::not_waited_for(sync::HostTime now) const {
  return static_cast<int>(std::count_if(walls_.begin(), walls_.end(), [&](const auto& w) {
    return w.second.given_up && now - w.second.heard <= kGone;
  }));
}

}  // namespace tactus::visual
