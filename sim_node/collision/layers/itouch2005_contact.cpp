#include <algorithm>
#include <cmath>

#include "sim_node/collision/layers/point_pairs.h"

namespace tactus::sim {

using layer2::Heights;

namespace {

Heights distances(const Heights& h) { return {std::abs(h[0]), std::abs(h[1]), std::abs(h[2])}; }

bool any_in(const Triangle& of, const Heights& distance, const Triangle& t, double tolerance_m) {
  for (std::size_t i = 0; i < 3; ++i)
    if (distance[i] <= tolerance_m && layer2::in_prism(of.v[i], t)) return true;
  return false;
}

void project_active(const Triangle& of, const ActiveVertices& active, const Heights& h, const Triangle& t,
                    bool of_a, std::vector<PointPair>& out) {
  for (std::size_t i = 0; i < 3; ++i)
    if (active.vertex[i] && layer2::in_prism(of.v[i], t)) out.push_back(layer2::over_face(of.v[i], t, h[i], of_a));
}

bool active_edge(const ActiveVertices& active, std::size_t i) {
  return active.vertex[i] && active.vertex[(i + 1) % 3];
}

}  // namespace

ActiveVertices active_vertices(const std::array<double, 3>& distances_m, const Reach& reach) {
  ActiveVertices active;
  const double nearest = *std::min_element(distances_m.begin(), distances_m.end());
  for (std::size_t i = 0; i < 3; ++i) {
    active.vertex[i] = distances_m[i] <= reach.tolerance_m && distances_m[i] - nearest <= reach.margin_m;
    active.count += active.vertex[i];
  }
  return active;
}

void itouch2005_contact(const Triangle& a, const Triangle& b, const Reach& reach, std::vector<PointPair>& out) {
  // A degenerate triangle has no plane.
  if (a.normal.isZero() || b.normal.isZero()) return;
  const double tol = reach.tolerance_m;
  const Heights over_b = layer2::heights(a, b), over_a = layer2::heights(b, a);
  const Heights of_a = distances(over_b), of_b = distances(over_a);
  const std::size_t first = out.size();
  const auto add = [&](const PointPair& p) { out.push_back(p); };
  ContactKind kind = ContactKind::kPoint;
  if (any_in(a, of_a, b, tol) || any_in(b, of_b, a, tol)) {
    const ActiveVertices active_a = active_vertices(of_a, reach), active_b = active_vertices(of_b, reach);
    const int order = std::max(active_a.count, active_b.count);
    kind = order == 3 ? ContactKind::kSurface : order == 2 ? ContactKind::kEdge : ContactKind::kPoint;
    project_active(a, active_a, over_b, b, true, out);
    project_active(b, active_b, over_a, a, false, out);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        if (active_edge(active_a, i) && active_edge(active_b, j)) layer2::between_edges(a, i, b, j, tol, add);
  } else {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) layer2::between_edges(a, i, b, j, tol, add);
    // Crossing edges meet in one point, parallel edges in two.
    if (out.size() > first) kind = kind_by_extent(out.data() + first, out.data() + out.size(), reach);
  }
  for (std::size_t i = first; i < out.size(); ++i) out[i].kind = kind;
}

}  // namespace tactus::sim
