// The solid that a triangle mesh encloses, whichever way its triangles face. Pure.
#pragma once

#include <cstddef>
#include <string>

#include "sim_node/model/triangles.h"

namespace tactus::sim {

struct MeshSolid {
  VolumeIntegral integral;  // of density 1; volume > 0, inertia positive definite
  // Empty: the mesh is closed and this is its volume. Otherwise one clause that completes "the mesh ...".
  std::string remark;
};

// Volume, centroid and inertia of a mesh. Its shells (mesh_shells.h) are added by the absolute value of their volume, so that a
// mesh that is inside out has the volume of the same mesh outside out. A shell inside another one that faces the other side
// than the outermost shell around it is a cavity and is subtracted; shells that overlap otherwise count twice. An opening is
// closed by triangles to the middle of its rim, and the remark gives the number of open edges. A mesh that encloses less than
// a thousandth of its bounding box with openings, nothing, more than its bounding box, or a one-sided surface counts as its
// bounding box, at least 0.1 mm thick, which the remark reports. O(n log n). Pre: mesh has a triangle with an area.
MeshSolid solid_of(const TriangleMesh& mesh);

struct TurnedTriangles {
  std::size_t turned = 0;    // triangles that faced inwards, or the other side than their neighbours
  std::size_t repeated = 0;  // removed triangles of closed shells, whose corners another one has
  std::size_t shells = 0;    // closed shells that were turned as a whole
  bool any() const { return turned + repeated > 0; }
};

// Lets the triangles of closed shells face out of the solid that solid_of() measures, and those of open shells the side of the
// larger part of their neighbours: an open surface has two sides that can be meant. A one-sided surface, and an open shell whose
// triangles exist twice, for both sides, stay as they are. Keeps the vertices, and the order of the triangles. O(n log n).
TurnedTriangles turn_outwards(TriangleMesh& mesh);

}  // namespace tactus::sim
