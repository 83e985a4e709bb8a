// Who stands on whom: contacts in layers, from what never moves upwards. Sweeps that follow them carry a weight
// through a stack in one go, and a last pass lets each body adapt to the one below it as if that were fixed: shock
// propagation (Guendelman, Bridson and Fedkiw 2003, section 8.2). Without it the error that sweeps leave makes
// tall stacks wander.
#pragma once

#include <vector>

#include "sim_node/behaviour/impulse/contact_rows.h"

namespace tactus::sim::impulse {

class Layers {
 public:
  // movers: how many numbers of movers there are. Realtime-safe once its lists have grown.
  void find(const ContactRows& rows, int movers);
  // All points, the lowest layer first; within a layer the points of neighbouring groups take turns, so that a
  // processor need not wait for the body that it has just moved.
  const std::vector<int>& points() const { return points_; }
  // The last pass, over contacts between free bodies that stand on something; what flies keeps its momentum.
  void settle(ContactRows& rows, Velocities& v);

 private:
  int layer_of(int mover) const { return mover < 0 ? 0 : layer_[static_cast<std::size_t>(mover)]; }

  std::vector<int> layer_;  // per mover: steps from what never moves; of those that touch something
  std::vector<int> order_;  // of groups, the lowest layer first
  std::vector<int> points_;
  ContactRows above_;  // the points of one group with the lower body fixed
};

}  // namespace tactus::sim::impulse
