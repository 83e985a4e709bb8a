// A smoother, finer mesh for the eye.
#pragma once

#include "sim_node/model/world_def.h"

namespace tactus::sim {

// Each triangle becomes four, `times` over, by the masks of Loop (1987, "Smooth subdivision surfaces based on
// triangles", p. 31), and along boundaries and edges (where the normals of the two sides differ) by those of Hoppe
// et al. (1994, fig. 5): what is sharp stays sharp. Positions alone say what is connected; a picture lies as it
// lay on the triangles. Normals are made anew, tangents are not. Throws std::runtime_error with one clause when
// that is more triangles than a mesh may have.
TriangleMesh subdivide(const TriangleMesh& mesh, int times);

}  // namespace tactus::sim
