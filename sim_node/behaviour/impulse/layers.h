// Contacts in layers, from static bodies upwards. Sweeps in this order carry a weight through a stack in one pass. A
// last pass adapts each body to the one below it as if that were static: shock propagation (Guendelman, Bridson and
// Fedkiw 2003, section 8.2). Without it the residual of the sweeps makes tall stacks wander.
#pragma once

#include <vector>

#include "sim_node/behaviour/impulse/contact_rows.h"

namespace tactus::sim::impulse {

class ContactLayers {
 public:
  // movers: number of mover indices. Real-time safe once its lists have grown.
  void find(const ContactRows& rows, int movers);
  // All points, lowest layer first. Within a layer the points of neighbouring groups are interleaved, so that the
  // processor does not wait for the body that it has just updated.
  const std::vector<int>& points() const { return points_; }
  // The last pass, over contacts between free bodies that rest on something. Flying bodies keep their momentum.
  void propagate_shock(ContactRows& rows, Velocities& v);

 private:
  int layer_of(int mover) const { return mover < 0 ? 0 : layer_[static_cast<std::size_t>(mover)]; }

  std::vector<int> layer_;  // per mover with contacts: number of steps from a static body
  std::vector<int> order_;  // of groups, the lowest layer first
  std::vector<int> points_;
  ContactRows above_;  // the points of one group with a static lower body
};

}  // namespace tactus::sim::impulse
