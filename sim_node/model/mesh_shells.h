// Cuts a triangle mesh into shells, each of which encloses a volume by itself, and lets the triangles of a shell face one
// way. Pure.
#pragma once

#include <array>
#include <vector>

#include "sim_node/model/world_def.h"

namespace tactus::sim {

// A directed edge that belongs to one triangle more than its opposite: the rim of an opening.
struct RimEdge {
  int from = 0, to = 0;  // indices of welded vertices
};

// Triangles that share edges. Without a rim it is a closed surface; with one it is open.
struct MeshShell {
  std::vector<std::array<int, 3>> triangles;  // indices of welded vertices; neighbours face the same side
  std::vector<int> source;                    // of each triangle: its number in the mesh
  std::vector<char> turned;                   // of each triangle: it faced the other side in the mesh
  std::vector<RimEdge> rim;
  bool one_sided = false;  // a Moebius strip or a Klein bottle: it has no inside
};

struct MeshShells {
  std::vector<Eigen::Vector3d> vertices;  // m, vertices at one place are one vertex
  std::vector<MeshShell> shells;
  int turned_triangles = 0;  // triangles that faced the other side than their neighbours
  std::vector<std::array<int, 2>> repeated;  // numbers of a triangle that is in no shell, and of the one whose corners it repeats
};

// Welds vertices nearer than a millionth of the diagonal (a thousandth, far from the origin of the file), drops repeated
// triangles, and turns triangles that face the other side than the larger part of the triangles around them. Several shells
// that meet in an edge stay apart if each is closed. O(n log n).
MeshShells shells_of(const TriangleMesh& mesh);

}  // namespace tactus::sim
