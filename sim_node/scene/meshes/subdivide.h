// Subdivision of a mesh for display: smoother and finer.
#pragma once

#include "sim_node/model/world_def.h"

namespace tactus::sim {

// Divides each triangle into four, `times` times, by the masks of Loop (1987, "Smooth subdivision surfaces based on
// triangles", p. 31), and along boundaries and edges (where the normals of the two sides differ) by those of Hoppe et
// al. (1994, fig. 5), so that edges stay sharp. Connectivity follows from positions alone; texture coordinates are
// interpolated linearly. Recomputes normals, but not tangents. Throws std::runtime_error with one clause when the
// result has too many triangles.
TriangleMesh subdivide(const TriangleMesh& mesh, int times);

}  // namespace tactus::sim
