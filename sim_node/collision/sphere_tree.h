// A bounding volume hierarchy over static spheres, for those near a point. Query time grows slowly with the number of
// spheres.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace tactus::sim {

class SphereTree {
 public:
  struct Sphere {
    Eigen::Vector3d centre_m{0, 0, 0};
    double radius_m = 0;  // may be infinite
    int id = 0;
  };
  SphereTree() = default;
  explicit SphereTree(std::vector<Sphere> spheres);

  // Appends the id of every sphere within reach of the point, and of some that are slightly further. Real-time safe
  // once `out` has grown.
  void near(const Eigen::Vector3d& place, double reach_m, std::vector<int>& out) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0, count = 0;  // spheres of a leaf
    int right = -1;            // the left child follows its parent
  };
  int build(int first, int count);

  std::vector<Sphere> spheres_;
  std::vector<Node> nodes_;
  std::vector<int> everywhere_;  // ids of unbounded spheres
};

}  // namespace tactus::sim
