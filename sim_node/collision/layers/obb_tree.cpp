#include "sim_node/collision/layers/obb_tree.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "sim_node/collision/layers/inner_edges.h"

namespace tactus::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// A split with less than this share on one side is replaced by a split in halves, so that no soup makes a deep tree.
constexpr int kMinShareDivisor = 8;
// Ratio of the smallest height to the longest edge below which a triangle has no normal: ten times the rounding of
// the vertices to double.
constexpr double kFlat = 1e-14;

struct Box {
  Vector3d centre{0, 0, 0}, half{0, 0, 0};
  Matrix3d axes = Matrix3d::Identity();  // rows
  int left = -1, right = -1, triangle = -1;
  double surface() const { return half.x() * half.y() + half.y() * half.z() + half.z() * half.x(); }
};

Triangle triangle_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  Triangle t{{a, b, c}, Vector3d::Zero(), {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()}, {}};
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  // The cross product at the corner between the two shorter edges is the most accurate.
  const Vector3d n = longest == (b - a).squaredNorm()   ? (a - c).cross(b - c)
                     : longest == (c - b).squaredNorm() ? (b - a).cross(c - a)
                                                        : (c - b).cross(a - b);
  if (!(n.norm() > kFlat * longest)) return t;
  t.normal = n.normalized();
  for (int i = 0; i < 3; ++i) t.inward[i] = t.normal.cross(t.v[(i + 1) % 3] - t.v[i]).normalized();
  return t;
}

// Covariance of the surface of the triangles, with uniform weight per area (Gottschalk 1996, equation 2).
Matrix3d covariance(const std::vector<Triangle>& triangles, std::span<const int> part) {
  Matrix3d sum = Matrix3d::Zero();
  Vector3d mean = Vector3d::Zero();
  double area = 0;
  const Vector3d near = triangles[static_cast<std::size_t>(part[0])].v[0];  // relative coordinates avoid cancellation far from the origin
  for (const int i : part) {
    const auto& at = triangles[static_cast<std::size_t>(i)].v;
    const Vector3d v[3] = {at[0] - near, at[1] - near, at[2] - near};
    // Degenerate triangles get a small weight, so that a soup of needles also has a direction.
    const Vector3d e = v[1] - v[0], f = v[2] - v[0];
    const double w = e.cross(f).norm() + 1e-12 * (e.squaredNorm() + f.squaredNorm());
    const Vector3d m = (v[0] + v[1] + v[2]) / 3;
    area += w;
    mean += w * m;
    sum += w / 12 *
           (9 * m * m.transpose() + v[0] * v[0].transpose() + v[1] * v[1].transpose() + v[2] * v[2].transpose());
  }
  if (!(area > 0)) return Matrix3d::Zero();
  mean /= area;
  return sum / area - mean * mean.transpose();
}

Matrix3d axes_of(const std::vector<Triangle>& triangles, std::span<const int> part) {
  const Triangle& first = triangles[static_cast<std::size_t>(part[0])];
  if (part.size() == 1) {
    int longest = 0;
    for (int i = 1; i < 3; ++i)
      if ((first.v[(i + 1) % 3] - first.v[i]).norm() > (first.v[(longest + 1) % 3] - first.v[longest]).norm())
        longest = i;
    const Vector3d along = first.v[(longest + 1) % 3] - first.v[longest];
    if (!(along.norm() > 0)) return Matrix3d::Identity();
    const Vector3d x = along.normalized(), n = first.normal.isZero() ? x.unitOrthogonal() : first.normal;
    Matrix3d axes;
    axes << x.transpose(), n.cross(x).normalized().transpose(), n.transpose();
    return axes;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(covariance(triangles, part));
  return eigen.info() == Eigen::Success ? Matrix3d(eigen.eigenvectors().transpose())
                                        : Matrix3d(Matrix3d::Identity());
}

class Builder {
 public:
  explicit Builder(const std::vector<Triangle>& triangles) : triangles_(triangles), order_(triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    boxes.reserve(2 * triangles.size());
    build(0, order_.size());
  }
  std::vector<Box> boxes;

 private:
  // Rounds the axes first, so that the extents belong to the axes of the test.
  void fit(Box& box, std::span<const int> part) {
    box.axes = axes_of(triangles_, part).cast<float>().cast<double>();
    const Vector3d near = triangles_[static_cast<std::size_t>(part[0])].v[0];
    Vector3d low = Vector3d::Constant(std::numeric_limits<double>::max()), high = -low;
    for (const int i : part)
      for (const Vector3d& v : triangles_[static_cast<std::size_t>(i)].v) {
        const Vector3d p = box.axes * (v - near);
        low = low.cwiseMin(p), high = high.cwiseMax(p);
      }
    box.centre = near + box.axes.transpose() * ((low + high) / 2);
    box.half = (high - low) / 2;
  }

  int build(std::size_t first, std::size_t count) {
    const int index = static_cast<int>(boxes.size());
    boxes.emplace_back();
    const std::span<int> part(order_.data() + first, count);
    Box box;
    fit(box, part);
    if (count == 1) {
      box.triangle = part[0];
    } else {
      Eigen::Index longest = 0;
      box.half.maxCoeff(&longest);
      const Vector3d axis = box.axes.row(longest);
      const auto along = [&](int i) {
        const auto& v = triangles_[static_cast<std::size_t>(i)].v;
        return axis.dot(v[0] + v[1] + v[2]);
      };
      double mean = 0;
      for (const int i : part) mean += along(i) / static_cast<double>(count);
      auto left = static_cast<std::size_t>(
          std::partition(part.begin(), part.end(), [&](int i) { return along(i) < mean; }) - part.begin());
      if (std::min(left, count - left) * kMinShareDivisor < count) {
        left = count / 2;
        std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(left), part.end(),
                         [&](int i, int j) { return along(i) < along(j); });
      }
      box.left = build(first, left);
      box.right = build(first + left, count - left);
    }
    boxes[static_cast<std::size_t>(index)] = box;
    return index;
  }

  const std::vector<Triangle>& triangles_;
  std::vector<int> order_;
};

// Collapses the binary tree: opens the largest of a node's boxes until there are eight.
class Gatherer {
 public:
  Gatherer(const std::vector<Box>& boxes, const Vector3d& origin, std::vector<WideNode>& nodes)
      : boxes_(boxes), origin_(origin), nodes_(nodes) {
    nodes_.emplace_back(WideNode{});
    put(0, 0, 0);
    nodes_[0].count = 1;
  }

 private:
  void put(std::size_t node, int lane, int from) {
    const Box& b = boxes_[static_cast<std::size_t>(from)];
    WideNode& n = nodes_[node];
    for (int i = 0; i < 3; ++i) {
      n.centre[i][lane] = static_cast<float>(b.centre[i] - origin_[i]);
      n.half[i][lane] = static_cast<float>(b.half[i]);
      for (int k = 0; k < 3; ++k) n.axis[i][k][lane] = static_cast<float>(b.axes(i, k));
    }
    n.size[lane] = static_cast<float>(b.half.norm());
    const int child = b.triangle >= 0 ? ~b.triangle : gather(from);
    nodes_[node].child[lane] = child;
  }

  int gather(int from) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back(WideNode{});
    int open[kLanes] = {boxes_[static_cast<std::size_t>(from)].left, boxes_[static_cast<std::size_t>(from)].right};
    int count = 2;
    while (count < kLanes) {
      int best = -1;
      double largest = -1;
      for (int i = 0; i < count; ++i) {
        const Box& b = boxes_[static_cast<std::size_t>(open[i])];
        if (b.triangle < 0 && b.surface() > largest) largest = b.surface(), best = i;
      }
      if (best < 0) break;
      const Box& b = boxes_[static_cast<std::size_t>(open[best])];
      open[best] = b.left;
      open[count++] = b.right;
    }
    nodes_[index].count = count;
    for (int i = 0; i < count; ++i) put(index, i, open[i]);
    return static_cast<int>(index);
  }

  const std::vector<Box>& boxes_;
  Vector3d origin_;
  std::vector<WideNode>& nodes_;
};

}  // namespace

ObbTree::ObbTree(std::span<const Vector3d> vertices, std::span<const int> indices) {
  if (indices.size() % 3 != 0)
    throw std::runtime_error("sim_node: a mesh has " + std::to_string(indices.size()) +
                             " indices, not a multiple of three; give three per triangle");
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const Vector3d* v[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const int at = indices[i + k];
      if (at < 0 || static_cast<std::size_t>(at) >= vertices.size() ||
          !vertices[static_cast<std::size_t>(at)].allFinite())
        throw std::runtime_error("sim_node: triangle " + std::to_string(i / 3) + " of a mesh has vertex " +
                                 std::to_string(at) + ", which is missing or not finite; correct the mesh");
      v[k] = &vertices[static_cast<std::size_t>(at)];
    }
    triangles_.push_back(triangle_of(*v[0], *v[1], *v[2]));
  }
  if (triangles_.empty()) return;
  mark_inner_edges(triangles_);
  const Builder builder(triangles_);
  origin_ = builder.boxes[0].centre;
  for (const Triangle& t : triangles_)
    for (const Vector3d& v : t.v) radius_m_ = std::max(radius_m_, (v - origin_).norm());
  nodes_.reserve(triangles_.size() / 3 + 2);
  Gatherer(builder.boxes, origin_, nodes_);
}

}  // namespace tactus::sim
