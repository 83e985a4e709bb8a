// What is done with triangles whoever they come from: checks, normals, extent, mass.
#pragma once

#include "sim_node/model/world_def.h"

namespace tactus::sim {

// Removes triangles without area and the vertices that nobody uses.
void remove_degenerate(TriangleMesh& mesh);

// Unit normals, the area-weighted mean of the triangles around a vertex, where none are given or they are no unit.
void complete_normals(TriangleMesh& mesh);

// Smallest box that holds all vertices, mapped by `pose`.
Eigen::AlignedBox3d bounds(const TriangleMesh& mesh, const Eigen::Isometry3d& pose);

// Volume m^3 (negative when turned inside out), centroid and second moments of a closed mesh of density 1: the sum over
// the tetrahedra between each triangle and the origin (Lien and Kajiya 1984, IEEE Computer Graphics 4(10)).
struct VolumeIntegral {
  double volume_m3 = 0;
  Eigen::Vector3d centroid_m{0, 0, 0};
  Eigen::Matrix3d inertia{Eigen::Matrix3d::Zero()};  // about the centroid, m^5
};
VolumeIntegral integrate(const TriangleMesh& mesh);

// A triangle mesh of a heightfield, at most `max_samples` a side, for the eye.
TriangleMesh triangulate(const Heightfield& field, int max_samples);

}  // namespace tactus::sim
