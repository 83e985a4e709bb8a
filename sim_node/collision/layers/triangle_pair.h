// Layer 2: the point pairs of the contact of two triangles. Both triangles and all points are in one frame.
#pragma once

#include <array>
#include <vector>

#include "sim_node/collision/layers/obb_tree.h"
#include "sim_node/model/point_pair.h"

namespace tactus::sim {

struct Reach {
  double tolerance_m = 1e-3;  // surfaces with a smaller gap touch
  double margin_m = 5e-4;     // distances that differ by less are equal: the surfaces are parallel there
};

// Appends to `out` all 6 vertices against the other's face and all 9 pairs of edges that are within the tolerance.
// The closest points of disjoint triangles are always among these, so no pair within the tolerance is missed. Where
// an edge passes through a face, it also appends that point, equal on both sides and marked as pierced. Layer 3
// removes duplicates. Gaps are >= 0.
void complete_contact(const Triangle& a, const Triangle& b, const Reach& reach, std::vector<PointPair>& out);

// I-Touch's algorithm, D6.8 section 1.6.2 to 1.6.4 (D6.8, 2005). It misses contacts where an edge pierces a face, and
// in some other cases: it tests either vertices over faces or edges, never both.
//
// "At least one vertex of t1 is in t2" is interpreted as: within the tolerance of its plane and inside its prism. The
// text also allows "within the tolerance of its plane". But then nearly every pair near a plane would go to
// PlanContact, which requires the prism and finds no contact, and would never reach EdgeEdge: 60 % of the true pairs
// of two noisy meshes would be missed, against 15 % with this interpretation.
void itouch2005_contact(const Triangle& a, const Triangle& b, const Reach& reach, std::vector<PointPair>& out);

// Active vertices of I-Touch, from the distances to a plane: the nearest vertex and those within the margin of it, if
// they are within the tolerance. One: vertex-plan, two: edge-plan, three: plan-plan.
struct ActiveVertices {
  std::array<bool, 3> vertex{};
  int count = 0;
};
ActiveVertices active_vertices(const std::array<double, 3>& distances_m, const Reach& reach);

// Type of a contact by its extent. The points within the margin of the deepest are one place, lie along a line, or
// span an area, each with the tolerance as the limit.
ContactKind kind_by_extent(const PointPair* first, const PointPair* last, const Reach& reach);

}  // namespace tactus::sim
