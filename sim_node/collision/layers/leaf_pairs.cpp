#include "sim_node/collision/layers/leaf_pairs.h"

#include <bit>

namespace tactus::sim {
namespace {

// Rounding of a test in float per metre of the coordinates: 24 bits, about ten operations on a value, and a reserve.
constexpr double kRounding = 4e-6;

struct Motion {  // from one tree's frame to the other's
  float rotation[3][3];
  float shift[3];
};

Motion motion_of(const Eigen::Isometry3d& to_from, const ObbTree& from, const ObbTree& to) {
  Motion m;
  const Eigen::Vector3d shift = to_from * from.origin() - to.origin();
  for (int i = 0; i < 3; ++i) {
    m.shift[i] = static_cast<float>(shift[i]);
    for (int k = 0; k < 3; ++k) m.rotation[i][k] = static_cast<float>(to_from.linear()(i, k));
  }
  return m;
}

inline void move(const WideNode& n, int lane, const Motion& m, BoxQuery& q) {
  for (int k = 0; k < 3; ++k) {
    q.centre[k] = m.rotation[k][0] * n.centre[0][lane] + m.rotation[k][1] * n.centre[1][lane] +
                  m.rotation[k][2] * n.centre[2][lane] + m.shift[k];
    q.half[k] = n.half[k][lane] + q.grow;
    for (int j = 0; j < 3; ++j)
      q.axis[j][k] = m.rotation[k][0] * n.axis[j][0][lane] + m.rotation[k][1] * n.axis[j][1][lane] +
                     m.rotation[k][2] * n.axis[j][2][lane];
  }
}

}  // namespace

LeafPairs::LeafPairs(Isa isa)
    : overlap_(isa == Isa::kAvx512 ? overlap_avx512
               : isa == Isa::kAvx2 ? overlap_avx2
                                   : overlap_baseline) {}

void LeafPairs::find(const ObbTree& a, const Eigen::Isometry3d& pose_a, const ObbTree& b,
                     const Eigen::Isometry3d& pose_b, double tolerance_m, std::vector<std::pair<int, int>>& out) {
  out.clear();
  if (a.empty() || b.empty()) return;
  const Eigen::Isometry3d b_from_a = pose_b.inverse() * pose_a;
  const Motion to_b = motion_of(b_from_a, a, b), to_a = motion_of(b_from_a.inverse(), b, a);
  const double apart = (b_from_a * a.origin() - b.origin()).norm();
  if (apart > a.radius_m() + b.radius_m() + tolerance_m) return;
  BoxQuery query;
  query.slack = static_cast<float>(kRounding * (apart + a.radius_m() + b.radius_m() + tolerance_m));
  query.grow = static_cast<float>(tolerance_m / 2) + query.slack;
  const WideNode *nodes_a = a.nodes().data(), *nodes_b = b.nodes().data();
  open_.clear();
  open_.push_back({{0, 0}, {0, 0}});
  while (!open_.empty()) {
    const Step s = open_.back();
    open_.pop_back();
    const WideNode &na = nodes_a[s.a.node], &nb = nodes_b[s.b.node];
    const int child_a = na.child[s.a.lane], child_b = nb.child[s.b.lane];
    if (child_a < 0 && child_b < 0) {
      out.emplace_back(~child_a, ~child_b);
      continue;
    }
    // Descends into the larger box, which makes the next test more selective.
    const bool open_a = child_b < 0 || (child_a >= 0 && na.size[s.a.lane] > nb.size[s.b.lane]);
    const WideNode& opened = open_a ? nodes_a[child_a] : nodes_b[child_b];
    if (open_a)
      move(nb, s.b.lane, to_a, query);
    else
      move(na, s.a.lane, to_b, query);
    for (unsigned hit = overlap_(opened, query); hit; hit &= hit - 1) {
      const int lane = std::countr_zero(hit);
      if (open_a)
        open_.push_back({{child_a, lane}, s.b});
      else
        open_.push_back({s.a, {child_b, lane}});
    }
  }
}

}  // namespace tactus::sim
