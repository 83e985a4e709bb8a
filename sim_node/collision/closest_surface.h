// The points of a shape's surface nearest to a place, with outward normals: what a tool can touch. Pure geometry.
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
  double distance_m = 0;            // of the place from the point, negative inside
  int triangle = -1;                // of a mesh
};

// One shape, ready for queries in its own frame.
class ClosestSurface {
 public:
  static constexpr int kMaxPlanes = 4;
  static constexpr double kMergeAngle_rad = 0.1745;  // default of the setting touch_merge_angle

  // mesh: the triangles of a mesh or heightfield, else ignored. Planes of a mesh whose directions differ by less than
  // merge_angle_rad are one.
  ClosestSurface(const ShapeDef& shape, const TriangleMesh* mesh, double merge_angle_rad = kMergeAngle_rad);
  // The same with a tree that others may use too; null or empty: no mesh.
  ClosestSurface(const ShapeDef& shape, std::shared_ptr<const TriangleTree> tree, double merge_angle_rad = kMergeAngle_rad);

  // Planes within `reach` of `place` (shape frame), nearest first, into `out`. A convex surface has one; a mesh has one
  // for each place that is nearer than all around it, so more where it is concave, and none of them cuts off another.
  void query(const Eigen::Vector3d& place, double reach_m, std::vector<SurfacePlane>& out) const;

  // Sphere around the shape, shape frame; infinite for a plane.
  const Eigen::Vector3d& centre() const { return centre_; }
  double bound_m() const { return bound_m_; }

 private:
  SurfacePlane primitive(const Eigen::Vector3d& place) const;
  bool nearest_around(std::size_t candidate) const;
  void mesh_planes(const Eigen::Vector3d& place, double reach_m, std::vector<SurfacePlane>& out) const;

  static constexpr std::size_t kMaxNear = 128;  // triangles that are looked at; the nearest

  ShapeKind kind_;
  double same_direction_;  // cosine
  Eigen::Vector3d size_m_;
  Eigen::Vector3d centre_{0, 0, 0};
  double bound_m_ = 0;
  std::shared_ptr<const TriangleTree> tree_;
  mutable std::vector<NearTriangle> near_;  // scratch: a query allocates nothing once it has grown
};

}  // namespace tactus::sim
