#include "sim_node/collision/triangle_tree.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim {

using Eigen::Vector3d;

Vector3d closest_on_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double scale = 1 / (va + vb + vc);
  return a + ab * (vb * scale) + ac * (vc * scale);
}

TriangleTree::TriangleTree(const std::vector<Vector3d>& vertices, const std::vector<int>& indices) {
  const auto vertex = [&](std::size_t i) { return vertices[static_cast<std::size_t>(indices[i])]; };
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    Triangle t{vertex(i), vertex(i + 1), vertex(i + 2), {}, static_cast<int>(i / 3)};
    const Vector3d n = (t.b - t.a).cross(t.c - t.a);
    if (n.norm() < 1e-14) continue;  // m^2: less than the area of a square of 0.1 um
    t.normal = n.normalized();
    triangles_.push_back(t);
  }
  if (!triangles_.empty()) build(0, static_cast<int>(triangles_.size()));
}

int TriangleTree::build(int first, int count) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Eigen::AlignedBox3d box, middles;
  const auto begin = triangles_.begin() + first, end = begin + count;
  for (auto t = begin; t != end; ++t) {
    box.extend(t->a).extend(t->b).extend(t->c);
    middles.extend(Vector3d(t->a + t->b + t->c));
  }
  nodes_[static_cast<std::size_t>(index)].box = box;
  if (count <= kLeaf) {
    nodes_[static_cast<std::size_t>(index)].first = first;
    nodes_[static_cast<std::size_t>(index)].count = count;
    return index;
  }
  Eigen::Index axis = 0;
  middles.sizes().maxCoeff(&axis);
  const auto half = begin + count / 2;
  std::nth_element(begin, half, end, [axis](const Triangle& x, const Triangle& y) {
    return x.a[axis] + x.b[axis] + x.c[axis] < y.a[axis] + y.b[axis] + y.c[axis];
  });
  build(first, count / 2);
  const int right = build(first + count / 2, count - count / 2);
  nodes_[static_cast<std::size_t>(index)].right = right;
  return index;
}

bool TriangleTree::on_triangle(const Vector3d& point, int triangle, double tolerance_m) const {
  const Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
  // Fast rejection by the distance to the plane.
  if (std::abs((point - t.a).dot(t.normal)) > tolerance_m) return false;
  return (closest_on_triangle(point, t.a, t.b, t.c) - point).squaredNorm() <= tolerance_m * tolerance_m;
}

void TriangleTree::near(const Vector3d& place, double reach_m, std::size_t max_count, std::vector<NearTriangle>& out) const {
  out.clear();
  if (nodes_.empty()) return;
  // Keeps the nearest triangles and reduces the reach to the last of them.
  const auto cut = [&] {
    const auto last = out.begin() + static_cast<std::ptrdiff_t>(max_count - 1);
    std::nth_element(out.begin(), last, out.end(),
                     [](const NearTriangle& a, const NearTriangle& b) { return a.distance_m < b.distance_m; });
    reach_m = last->distance_m;
    out.resize(max_count);
  };
  const auto far = [&](int index) { return nodes_[static_cast<std::size_t>(index)].box.squaredExteriorDistance(place); };
  struct Open {
    int node;
    double squared_m2;
  };
  Open stack[64];  // deeper than any tree of 2^31 triangles halved at each level
  int top = 0;
  stack[top++] = {0, far(0)};
  while (top > 0) {
    const Open open = stack[--top];
    if (open.squared_m2 > reach_m * reach_m) continue;
    const Node& node = nodes_[static_cast<std::size_t>(open.node)];
    if (node.right >= 0) {
      const Open left{open.node + 1, far(open.node + 1)}, right{node.right, far(node.right)};
      const bool left_first = left.squared_m2 <= right.squared_m2;
      stack[top++] = left_first ? right : left;
      stack[top++] = left_first ? left : right;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Triangle& t = triangles_[static_cast<std::size_t>(i)];
      const Vector3d point = closest_on_triangle(place, t.a, t.b, t.c);
      const double distance = (place - point).norm();
      if (distance <= reach_m) out.push_back({point, t.normal, distance, i});
    }
    if (out.size() >= 2 * max_count) cut();
  }
  if (out.size() > max_count) cut();
}

}  // namespace tactus::sim
