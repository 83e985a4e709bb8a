// Witness points of two near or overlapping surfaces: the result of a collision query.
#pragma once

#include <Eigen/Core>

#include "sim_node/model/contact_kind.h"

namespace tactus::sim {

struct PointPair {
  Eigen::Vector3d on_a_m = Eigen::Vector3d::Zero(), on_b_m = Eigen::Vector3d::Zero();  // world
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();                                   // unit, world, from a to b
  double gap_m = 0;                        // between the surfaces along the normal; negative: depth
  int triangle_a = -1, triangle_b = -1;    // of a mesh; -1: none
  ContactKind kind = ContactKind::kPoint;  // of the pair of surfaces, or of triangles in meshes
  bool pierced = false;                    // an edge passes through a face here
};

}  // namespace tactus::sim
