// Layer 2: from a pair of triangles to the point pairs of their contact. Both triangles and all points are in one
// frame.
#pragma once

#include <array>
#include <vector>

#include "sim_node/collision/layers/obb_tree.h"
#include "sim_node/model/point_pair.h"

namespace tactus::sim {

struct Reach {
  double tolerance_m = 1e-3;  // surfaces within this touch
  double margin_m = 5e-4;     // distances that differ by less are alike: the surfaces are parallel there
};

// All 6 vertices against the other's face and all 9 pairs of edges, as far as they are within the tolerance,
// appended to `out`. The closest points of disjoint triangles are always among these, so no pair within the
// tolerance is silent. Where an edge goes through a face the point where it does is given as well, twice the same,
// and marked as pierced. Duplicates are left to layer 3. Gaps are >= 0.
void complete_contact(const Triangle& a, const Triangle& b, const Reach& reach, std::vector<PointPair>& out);

// I-Touch's own, D6.8 section 1.6.2 to 1.6.4 (D6.8, 2005). Silent where an edge pierces a face, and elsewhere
// in some cases: it looks either for vertices over faces or for edges, never for both.
//
// "At least one vertex of t1 is in t2" is read as: within the tolerance of its plane and inside its prism. The
// text also allows "within the tolerance of its plane". But then nearly every pair near a plane would go to
// PlanContact, which asks for the prism and finds nothing, and would never come to EdgeEdge: 60 % of the true
// pairs of two noisy meshes would be silent, against 15 % with this reading.
void itouch2005_contact(const Triangle& a, const Triangle& b, const Reach& reach, std::vector<PointPair>& out);

// The vertices that I-Touch calls active, from their distances to a plane: the nearest one and those within the
// margin of it, as far as they are within the tolerance. One: vertex-plan, two: edge-plan, three: plan-plan.
struct Active {
  std::array<bool, 3> vertex{};
  int count = 0;
};
Active active_vertices(const std::array<double, 3>& distances_m, const Reach& reach);

// Type of a contact by its extent: the points within the margin of the deepest are one place, lie along a line, or
// span an area, each when they are the tolerance apart.
ContactKind kind_by_extent(const PointPair* first, const PointPair* last, const Reach& reach);

}  // namespace tactus::sim
