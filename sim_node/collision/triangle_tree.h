// A tree of boxes over the triangles of a mesh, for the triangles near a place.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace tactus::sim {

// Point of the triangle nearest to p (Ericson 2005, Real-Time Collision Detection, section 5.1.5: by Voronoi regions).
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
  // Degenerate triangles are left out.
  TriangleTree(const std::vector<Eigen::Vector3d>& vertices, const std::vector<int>& indices);

  // The triangles within reach, or the `most` nearest of them, in no order, into `out` (cleared first).
  void near(const Eigen::Vector3d& place, double reach_m, std::size_t most, std::vector<NearTriangle>& out) const;
  // Whether that point lies on the triangle, within a tolerance.
  bool on_triangle(const Eigen::Vector3d& point, int triangle, double tolerance_m) const;
  bool empty() const { return triangles_.empty(); }
  const Eigen::AlignedBox3d& box() const { return nodes_.front().box; }

 private:
  struct Triangle {
    Eigen::Vector3d a, b, c, normal;
  };
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0, count = 0;  // triangles of a leaf
    int right = -1;            // the left child follows its parent
  };
  static constexpr int kLeaf = 4;
  int build(int first, int count);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace tactus::sim
