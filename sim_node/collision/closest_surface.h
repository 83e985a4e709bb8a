// Closest points on a shape's surface with outward normals, as a tool needs them. Pure geometry.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "sim_node/collision/triangle_tree.h"
#include "sim_node/model/world_def.h"

namespace tactus::sim {

struct SurfacePlane {
  Eigen::Vector3d point{0, 0, 0};   // on the surface
  Eigen::Vector3d normal{0, 0, 1};  // unit, out of the body
  double distance_m = 0;            // signed distance from surface to query point, negative inside
  int triangle = -1;                // of a mesh; -1: none
};

// One shape, prepared for queries in its own frame.
class ClosestSurface {
 public:
  static constexpr int kMaxPlanes = 4;
  static constexpr double kMergeAngle_rad = 0.1745;  // default of the setting touch_merge_angle

  // tree: the triangles of a mesh or heightfield, which may be shared; null or empty: no mesh. Planes of a mesh whose
  // normals differ by less than merge_angle_rad are merged.
  ClosestSurface(const ShapeDef& shape, std::shared_ptr<const TriangleTree> tree, double merge_angle_rad = kMergeAngle_rad);

  // Writes the planes within `reach_m` of `place` (shape frame), nearest first, into `out`. A convex surface has one
  // plane. A mesh has one plane for each local minimum of the distance, so a concave mesh may have several. No plane
  // cuts off the point of another.
  void query(const Eigen::Vector3d& place, double reach_m, std::vector<SurfacePlane>& out) const;

  // Bounding sphere, shape frame. The radius of a plane is infinite.
  const Eigen::Vector3d& centre() const { return centre_; }
  double bound_m() const { return bound_m_; }

 private:
  SurfacePlane primitive(const Eigen::Vector3d& place) const;
  bool nearest_around(std::size_t candidate) const;
  void mesh_planes(const Eigen::Vector3d& place, double reach_m, std::vector<SurfacePlane>& out) const;

  static constexpr std::size_t kMaxNear = 128;  // number of nearest triangles that a query examines

  ShapeKind kind_;
  double same_direction_;  // cosine
  Eigen::Vector3d size_m_;
  Eigen::Vector3d centre_{0, 0, 0};
  double bound_m_ = 0;
  std::shared_ptr<const TriangleTree> tree_;
  mutable std::vector<NearTriangle> near_;  // scratch; a query allocates no memory once it has grown
};

}  // namespace tactus::sim
