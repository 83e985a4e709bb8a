#include "sim_node/behaviour/impulse/layers.h"

#include <algorithm>

namespace tactus::sim::impulse {
namespace {

constexpr int kFlies = 1 << 20;
constexpr int kMaxLayers = 256;   // bodies above count as flying
constexpr std::size_t kInterleaved = 8;  // number of interleaved groups; design: hides the latency of one point
constexpr int kSweeps = 5;         // over the points of one group; design: four corners converge to 1 %

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

void ContactLayers::propagate_shock(ContactRows& rows, Velocities& v) {
  std::swap(above_.inertias, rows.inertias);
  for (const int number : order_) {
    const ContactGroup& g = rows.groups[static_cast<std::size_t>(number)];
    const int low = std::min(layer_of(g.mover_a), layer_of(g.mover_b));
    if (low >= kFlies || low == 0 || layer_of(g.mover_a) == layer_of(g.mover_b)) continue;
    const bool b_above = layer_of(g.mover_b) > layer_of(g.mover_a);
    ContactPoint* first = rows.points.data() + g.first;
    if (first->couplings > 0) continue;
    // The velocity of the lower body is stored as drift, so that the point can be solved as if the body were static.
    above_.points.assign(first, first + g.count);
    for (ContactPoint& p : above_.points) {
      const Eigen::Vector3d both = rows.velocity(p, v);
      (b_above ? p.a : p.b) = 0;
      p.drift_m_s = both - above_.velocity(p, v);
      above_.compute_mobility(p);
    }
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (ContactPoint& p : above_.points) {
        Eigen::Vector3d u = above_.velocity(p, v) + p.drift_m_s;
        u.x() -= p.min_speed_m_s;
        const Eigen::Vector3d next = ContactRows::solve_point(p, p.impulse, u), by = next - p.impulse;
        p.impulse = next;
        above_.apply(p, by, v);
      }
  }
  std::swap(above_.inertias, rows.inertias);
}

}  // namespace tactus::sim::impulse
