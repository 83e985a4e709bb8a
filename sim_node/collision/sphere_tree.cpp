#include "sim_node/collision/sphere_tree.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim {

SphereTree::SphereTree(std::vector<Sphere> spheres) {
  for (Sphere& s : spheres) {
    if (std::isfinite(s.radius_m))
      spheres_.push_back(s);
    else
      everywhere_.push_back(s.id);
  }
  if (!spheres_.empty()) build(0, static_cast<int>(spheres_.size()));
}

int SphereTree::build(int first, int count) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Eigen::AlignedBox3d box, centres;
  const auto begin = spheres_.begin() + first, end = begin + count;
  for (auto s = begin; s != end; ++s) {
    const Eigen::Vector3d r = Eigen::Vector3d::Constant(s->radius_m);
    box.extend(s->centre_m - r).extend(s->centre_m + r);
    centres.extend(s->centre_m);
  }
  nodes_[static_cast<std::size_t>(index)].box = box;
  if (count <= 2) {
    nodes_[static_cast<std::size_t>(index)].first = first;
    nodes_[static_cast<std::size_t>(index)].count = count;
    return index;
  }
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  std::nth_element(begin, begin + count / 2, end,
                   [axis](const Sphere& x, const Sphere& y) { return x.centre_m[axis] < y.centre_m[axis]; });
  build(first, count / 2);
  const int right = build(first + count / 2, count - count / 2);
  nodes_[static_cast<std::size_t>(index)].right = right;
  return index;
}

void SphereTree::near(const Eigen::Vector3d& place, double reach_m, std::vector<int>& out) const {
  out.insert(out.end(), everywhere_.begin(), everywhere_.end());
  if (nodes_.empty()) return;
  int stack[64];  // deeper than any tree of 2^31 spheres halved at each level
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const int index = stack[--top];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.box.squaredExteriorDistance(place) > reach_m * reach_m) continue;
    if (node.right >= 0) {
      stack[top++] = node.right;
      stack[top++] = index + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Sphere& s = spheres_[static_cast<std::size_t>(i)];
      const double within = s.radius_m + reach_m;
      if ((place - s.centre_m).squaredNorm() <= within * within) out.push_back(s.id);
    }
  }
}

}  // namespace tactus::sim
