#include "sim_node/collision/features/feature_tree.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim::features {
namespace {

using Eigen::Vector3d;

// A connection over a face deviates from its normal by rounding only, rad.
constexpr double kFaceSlack_rad = 1e-3;
// Least component along an axis for which the distance follows from the height along that axis.
constexpr double kLeastRise = 0.1;
// Rounding to float of a sine or cosine.
constexpr double kConeRounding = 1e-6;

// A cone around all directions of the features.
DirectionCone around(const std::vector<int>& below, const std::vector<DirectionCone>& cones) {
  Vector3d sum = Vector3d::Zero();
  for (const int i : below) {
    const DirectionCone& c = cones[static_cast<std::size_t>(i)];
    if (c.cosine <= 0) return {};
    sum += c.axis.dot(sum) < 0 ? Vector3d(-c.axis) : c.axis;
  }
  if (!(sum.norm() > 1e-6)) return {};
  const Vector3d axis = sum.normalized();
  double widest_rad = 0;
  for (const int i : below) {
    const DirectionCone& c = cones[static_cast<std::size_t>(i)];
    widest_rad = std::max(widest_rad, std::acos(std::min(1.0, std::abs(axis.dot(c.axis)))) + std::asin(c.sine));
  }
  return direction_cone(axis, widest_rad + kConeRounding);
}

// Boxes of segments and points, from which ObbTree makes a tree. A point becomes a segment of a nanometre, because
// the axes of a box follow from the extent of its parts.
ObbTree segments(const std::vector<Vector3d>& from, const std::vector<Vector3d>& to) {
  std::vector<Vector3d> corners;
  std::vector<int> indices;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const int first = static_cast<int>(corners.size());
    corners.push_back(from[i]);
    corners.push_back(to[i]);
    indices.insert(indices.end(), {first, first + 1, first + 1});
  }
  return {corners, indices};
}

EdgeLanes lanes_of(const FeatureNode& node, const MeshFeatures& mesh) {
  EdgeLanes lanes{};
  for (int lane = 0; lane < node.count; ++lane) {
    if (node.child[lane] >= 0) continue;
    const MeshFeatures::Edge& e = mesh.edges[static_cast<std::size_t>(~node.child[lane])];
    lanes.half[lane] = static_cast<float>(e.length_m / 2);
    for (int k = 0; k < 3; ++k) {
      lanes.along[k][lane] = static_cast<float>(e.along[k]);
      for (int side = 0; side < 2; ++side) lanes.inward[side][k][lane] = static_cast<float>(e.inward[side][k]);
    }
  }
  return lanes;
}

FeatureTree points(const MeshFeatures& mesh, const std::vector<int>& numbers,
                   const std::vector<DirectionCone>& cones) {
  std::vector<Vector3d> from, to;
  for (const int v : numbers) {
    from.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    to.push_back(from.back() + Vector3d(1e-9, 0, 0));
  }
  return {segments(from, to), numbers, cones};
}

}  // namespace

FeatureTree::FeatureTree(const ObbTree& boxes, const std::vector<int>& features,
                         const std::vector<DirectionCone>& cones)
    : nodes_(boxes.nodes().size()), origin_(boxes.origin()), radius_m_(boxes.radius_m()) {
  if (boxes.empty()) nodes_.clear();
  if (!nodes_.empty()) gather(boxes, 0, features, cones);
}

std::vector<int> FeatureTree::gather(const ObbTree& boxes, std::size_t node, const std::vector<int>& features,
                                     const std::vector<DirectionCone>& cones) {
  const WideNode& from = boxes.nodes()[node];
  FeatureNode& to = nodes_[node];
  to = {};
  to.count = from.count;
  std::vector<int> all;
  for (int lane = 0; lane < from.count; ++lane) {
    const int child = from.child[lane];
    const std::vector<int> below =
        child < 0 ? std::vector<int>{~child} : gather(boxes, static_cast<std::size_t>(child), features, cones);
    for (int i = 0; i < 3; ++i) {
      to.centre[i][lane] = from.centre[i][lane];
      to.half[i][lane] = from.half[i][lane];
      for (int k = 0; k < 3; ++k) to.axis[i][k][lane] = from.axis[i][k][lane];
    }
    to.size[lane] = from.size[lane];
    to.child[lane] = child < 0 ? ~features[static_cast<std::size_t>(~child)] : child;
    if (child >= 0) to.inner |= 1u << lane;
    set_directions(node, lane, below, cones);
    all.insert(all.end(), below.begin(), below.end());
  }
  return all;
}

void FeatureTree::set_directions(std::size_t node, int lane, const std::vector<int>& below,
                                 const std::vector<DirectionCone>& cones) {
  FeatureNode& n = nodes_[node];
  double slope[3] = {0, 0, 0}, rise[3] = {1, 1, 1};
  for (const int i : below) {
    const DirectionCone& c = cones[static_cast<std::size_t>(i)];
    const double half_rad = c.cosine > 0 ? std::asin(c.sine) : M_PI / 2;
    for (int k = 0; k < 3; ++k) {
      const Vector3d axis(n.axis[k][0][lane], n.axis[k][1][lane], n.axis[k][2][lane]);
      const double off_rad = c.cosine > 0 ? std::acos(std::min(1.0, std::abs(axis.dot(c.axis)))) : 0;
      slope[k] = std::max(slope[k], std::cos(std::max(0.0, off_rad - half_rad)));
      rise[k] = std::min(rise[k], std::cos(std::min(M_PI / 2, off_rad + half_rad)));
    }
  }
  int best = 0;
  for (int k = 1; k < 3; ++k)
    if (rise[k] > rise[best]) best = k;
  std::swap(slope[best], slope[2]);
  std::swap(n.half[best][lane], n.half[2][lane]);
  for (int k = 0; k < 3; ++k) {
    std::swap(n.axis[best][k][lane], n.axis[2][k][lane]);
    n.slope[k][lane] = static_cast<float>(slope[k] + kConeRounding);
  }
  n.per_rise[lane] = rise[best] > kLeastRise ? static_cast<float>((1 + 1e-5) / rise[best]) : 1e9f;
  const DirectionCone cone = around(below, cones);
  for (int k = 0; k < 3; ++k) n.cone[k][lane] = static_cast<float>(cone.axis[k]);
  n.cosine[lane] = static_cast<float>(cone.cosine);
  n.sine[lane] = static_cast<float>(cone.sine);
}

FeatureTrees::FeatureTrees(const ObbTree& tree) : mesh(tree.triangles()) {
  std::vector<int> numbers;
  std::vector<DirectionCone> cones;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    numbers.push_back(static_cast<int>(i));
    cones.push_back(
        direction_cone(mesh.triangles[i].normal, mesh.triangles[i].normal.isZero() ? 4 : kFaceSlack_rad));
  }
  faces = FeatureTree(tree, numbers, cones);

  std::vector<Vector3d> from, to;
  numbers.clear(), cones.clear();
  for (std::size_t i = 0; i < mesh.edges.size(); ++i) {
    numbers.push_back(static_cast<int>(i));
    cones.push_back(mesh.cone_of_edge(static_cast<int>(i)));
    from.push_back(mesh.vertices[static_cast<std::size_t>(mesh.edges[i].ends[0])]);
    to.push_back(mesh.vertices[static_cast<std::size_t>(mesh.edges[i].ends[1])]);
  }
  edges = FeatureTree(segments(from, to), numbers, cones);
  for (const FeatureNode& n : edges.nodes()) edge_lanes.push_back(lanes_of(n, mesh));

  std::vector<int> all, some;
  std::vector<DirectionCone> of_some;
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
    all.push_back(v);
    const DirectionCone cone = mesh.cone_of_vertex(v);
    if (cone.empty) continue;
    some.push_back(v);
    of_some.push_back(cone);
  }
  vertices = points(mesh, all, std::vector<DirectionCone>(all.size()));
  peaks = points(mesh, some, of_some);
}

}  // namespace tactus::sim::features
