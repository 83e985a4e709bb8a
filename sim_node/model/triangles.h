// Operations on triangle meshes from any source: validation, normals, bounds, mass properties.
#pragma once

#include "sim_node/model/world_def.h"

namespace tactus::sim {

// Removes triangles without area and unused vertices.
void remove_degenerate(TriangleMesh& mesh);

// Computes unit normals, the area-weighted mean of the triangles around a vertex, where normals are missing or not of
// unit length.
void complete_normals(TriangleMesh& mesh);

// Smallest axis-aligned box around all vertices, mapped by `pose`.
Eigen::AlignedBox3d bounds(const TriangleMesh& mesh, const Eigen::Isometry3d& pose);

// Volume m^3 (negative for an inverted mesh), centroid and second moments of a closed mesh of density 1: the sum over
// the tetrahedra between each triangle and the origin (Lien and Kajiya 1984, IEEE Computer Graphics 4(10)).
struct VolumeIntegral {
  double volume_m3 = 0;
  Eigen::Vector3d centroid_m{0, 0, 0};
  Eigen::Matrix3d inertia{Eigen::Matrix3d::Zero()};  // about the centroid, m^5
};
VolumeIntegral integrate(const TriangleMesh& mesh);

// Triangle mesh of a heightfield for drawing, with at most `max_samples` per side.
TriangleMesh triangulate(const Heightfield& field, int max_samples);

}  // namespace tactus::sim
