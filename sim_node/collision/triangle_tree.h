// Tree of axis-aligned boxes over the triangles of a mesh, for the triangles near a point.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace tactus::sim {

// Closest point on the triangle to p (Ericson 2005, Real-Time Collision Detection, section 5.1.5: by Voronoi
// regions).
Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c);

struct NearTriangle {
  Eigen::Vector3d point{0, 0, 0};
  Eigen::Vector3d face_normal{0, 0, 1};
  double distance_m = 0;  // >= 0
  int triangle = -1;
};

class TriangleTree {
 public:
  TriangleTree() = default;
  // Ignores degenerate triangles.
  TriangleTree(const std::vector<Eigen::Vector3d>& vertices, const std::vector<int>& indices);

  // Writes the triangles within reach, or the `max_count` nearest of them, unordered, into `out` after clearing it.
  void near(const Eigen::Vector3d& place, double reach_m, std::size_t max_count, std::vector<NearTriangle>& out) const;
  // Whether the point lies on the triangle, within a tolerance.
  bool on_triangle(const Eigen::Vector3d& point, int triangle, double tolerance_m) const;
  // Calls visit(a, b, c, index in the mesh) for each triangle whose box overlaps `box`.
  template <class Visit>
  void each_within(const Eigen::AlignedBox3d& box, Visit&& visit) const;
  // Calls visit(corner, mesh index of its triangle) for the corners with n . corner <= limit. A corner is visited
  // once for each of its triangles.
  template <class Visit>
  void each_corner_below(const Eigen::Vector3d& n, double limit_m, Visit&& visit) const;
  bool empty() const { return triangles_.empty(); }
  // Mesh index of a triangle, from NearTriangle::triangle.
  int number(int triangle) const { return triangles_[static_cast<std::size_t>(triangle)].number; }
  const Eigen::AlignedBox3d& box() const { return nodes_.front().box; }

 private:
  struct Triangle {
    Eigen::Vector3d a, b, c, normal;
    int number = -1;  // index in the mesh
  };
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0, count = 0;  // triangles of a leaf
    int right = -1;            // the left child follows its parent
  };
  static constexpr int kLeaf = 4;
  int build(int first, int count);
  // Visits the leaves whose boxes, and whose parents' boxes, satisfy `wanted`.
  template <class Wanted, class Visit>
  void each(Wanted&& wanted, Visit&& visit) const;

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

template <class Wanted, class Visit>
void TriangleTree::each(Wanted&& wanted, Visit&& visit) const {
  if (nodes_.empty()) return;
  int stack[64];  // deeper than any tree of 2^31 triangles halved at each level
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const int at = stack[--top];
    const Node& node = nodes_[static_cast<std::size_t>(at)];
    if (!wanted(node.box)) continue;
    if (node.right >= 0) {
      stack[top++] = node.right;
      stack[top++] = at + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) visit(triangles_[static_cast<std::size_t>(i)]);
  }
}

template <class Visit>
void TriangleTree::each_within(const Eigen::AlignedBox3d& box, Visit&& visit) const {
  each([&](const Eigen::AlignedBox3d& b) { return b.intersects(box); },
       [&](const Triangle& t) {
         const Eigen::AlignedBox3d own(t.a.cwiseMin(t.b).cwiseMin(t.c), t.a.cwiseMax(t.b).cwiseMax(t.c));
         if (own.intersects(box)) visit(t.a, t.b, t.c, t.number);
       });
}

template <class Visit>
void TriangleTree::each_corner_below(const Eigen::Vector3d& n, double limit_m, Visit&& visit) const {
  each([&](const Eigen::AlignedBox3d& b) { return n.dot(b.center()) - 0.5 * n.cwiseAbs().dot(b.sizes()) <= limit_m; },
       [&](const Triangle& t) {
         for (const Eigen::Vector3d* corner : {&t.a, &t.b, &t.c})
           if (n.dot(*corner) <= limit_m) visit(*corner, t.number);
       });
}

}  // namespace tactus::sim
