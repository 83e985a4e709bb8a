#include "visual_node/overlay/body_groups.h"

#include <algorithm>
#include <tactus/body_state_t.hpp>

namespace tactus::visual {
namespace {

// design: as in the flashes, warm for bodies near the hand, cool for the others.
const Eigen::Vector4f kHaptic{1.0f, 0.55f, 0.1f, 0.6f}, kVisual{0.25f, 0.5f, 1.0f, 0.6f};

}  // namespace

void BodyGroups::push(const world_state_t& m) {
  if (m.header.incarnation != incarnation_) body_groups_.clear();
  incarnation_ = m.header.incarnation;
  for (const body_state_t& b : m.bodies) {
    if (b.body < 0 || b.body >= kMaxBodies) continue;
    BodyGroup& group = body_groups_[b.body];
    if (m.header.seq < group.seq) continue;  // an older message that arrived late
    group = {m.header.seq, m.group == world_state_t::AHEAD};
  }
}

std::vector<Eigen::Vector4f> BodyGroups::tints(std::size_t bodies) const {
  std::vector<Eigen::Vector4f> tints(bodies, Eigen::Vector4f::Zero());
  for (const auto& [body, group] : body_groups_)
    if (static_cast<std::size_t>(body) < bodies)
      tints[static_cast<std::size_t>(body)] = group.ahead ? kVisual : kHaptic;
  return tints;
}

std::size_t BodyGroups::count(bool ahead) const {
  return static_cast<std::size_t>(std::count_if(body_groups_.begin(), body_groups_.end(),
                                                [&](const auto& t) { return t.second.ahead == ahead; }));
}

}  // namespace tactus::visual
