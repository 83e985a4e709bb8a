// Contacts in layers, from static bodies upwards. Sweeps in this order carry a weight through a stack in one pass.
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

 private:
  int layer_of(int mover) const { return mover < 0 ? 0 : layer_[static_cast<std::size_t>(mover)]; }

  std::vector<int> layer_;  // per mover with contacts: number of steps from a static body
  std::vector<int> order_;  // of groups, the lowest layer first
  std::vector<int> points_;
};

}  // namespace tactus::sim::impulse
