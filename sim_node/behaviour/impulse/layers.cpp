#include "sim_node/behaviour/impulse/layers.h"

#include <algorithm>

namespace tactus::sim::impulse {
namespace {

constexpr int kFlies = 1 << 20;
constexpr int kMaxLayers = 256;   // bodies above count as flying
constexpr std::size_t kInterleaved = 8;  // number of interleaved groups; design: hides the latency of one point

}  // namespace

void ContactLayers::find(const ContactRows& rows, int movers) {
  layer_.resize(static_cast<std::size_t>(movers), kFlies);
  for (const ContactGroup& g : rows.groups)
    for (const int mover : {g.mover_a, g.mover_b})
      if (mover >= 0) layer_[static_cast<std::size_t>(mover)] = kFlies;
  bool changed = true;
  for (int pass = 0; changed && pass < kMaxLayers; ++pass) {
    changed = false;
    for (const ContactGroup& g : rows.groups) {
      const auto lift = [&](int below, int mover) {
        if (mover < 0 || layer_of(below) + 1 >= layer_of(mover)) return;
        layer_[static_cast<std::size_t>(mover)] = layer_of(below) + 1;
        changed = true;
      };
      lift(g.mover_a, g.mover_b);
      lift(g.mover_b, g.mover_a);
    }
  }
  order_.resize(rows.groups.size());
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<int>(i);
  const auto height = [&](int group) {
    const ContactGroup& g = rows.groups[static_cast<std::size_t>(group)];
    return std::min(layer_of(g.mover_a), layer_of(g.mover_b));
  };
  std::sort(order_.begin(), order_.end(),
            [&](int a, int b) { return height(a) != height(b) ? height(a) < height(b) : a < b; });
  points_.clear();
  for (std::size_t begin = 0; begin < order_.size(); begin += kInterleaved) {
    const std::size_t end = std::min(order_.size(), begin + kInterleaved);
    for (int point = 0;; ++point) {
      const std::size_t before = points_.size();
      for (std::size_t i = begin; i < end; ++i) {
        const ContactGroup& g = rows.groups[static_cast<std::size_t>(order_[i])];
        if (point < g.count) points_.push_back(g.first + point);
      }
      if (points_.size() == before) break;
    }
  }
}

}  // namespace tactus::sim::impulse
