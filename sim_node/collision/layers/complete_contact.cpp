#include <algorithm>

#include "sim_node/collision/layers/pair_features.h"

namespace tactus::sim {

using Eigen::Vector3d;
using layer2::Heights;
using layer2::Sides;

ContactKind kind_by_extent(const PointPair* first, const PointPair* last, const Reach& reach) {
  if (last - first < 2) return ContactKind::kPoint;
  const PointPair* deepest =
      std::min_element(first, last, [](const PointPair& x, const PointPair& y) { return x.gap_m < y.gap_m; });
  const auto counts = [&](const PointPair& p) { return p.gap_m <= deepest->gap_m + reach.margin_m; };
  Vector3d along = Vector3d::Zero();
  for (const PointPair* p = first; p != last; ++p)
    if (counts(*p) && (p->on_a_m - deepest->on_a_m).squaredNorm() > along.squaredNorm())
      along = p->on_a_m - deepest->on_a_m;
  if (along.norm() < reach.tolerance_m) return ContactKind::kPoint;
  along.normalize();
  double left = 0, right = 0;
  Vector3d across = Vector3d::Zero();
  for (const PointPair* p = first; p != last; ++p) {
    if (!counts(*p)) continue;
    const Vector3d d = p->on_a_m - deepest->on_a_m, side = d - d.dot(along) * along;
    if (across.isZero()) across = side;
    (side.dot(across) < 0 ? left : right) = std::max(side.dot(across) < 0 ? left : right, side.norm());
  }
  return left + right < reach.tolerance_m ? ContactKind::kEdge : ContactKind::kSurface;
}

void complete_contact(const Triangle& a, const Triangle& b, const Reach& reach, std::vector<PointPair>& out) {
  const double tol = reach.tolerance_m;
  const Heights over_b = layer2::heights(a, b);
  if (layer2::out_of_reach(over_b, tol)) return;
  const Heights over_a = layer2::heights(b, a);
  if (layer2::out_of_reach(over_a, tol)) return;
  const Sides in_b = layer2::sides(a, b), in_a = layer2::sides(b, a);
  if (layer2::out_of_reach(in_b, tol) || layer2::out_of_reach(in_a, tol)) return;
  const std::size_t first = out.size();
  const auto add = [&](const PointPair& p) { out.push_back(p); };
  layer2::vertices_and_edges(a, over_b, in_b, b, over_a, in_a, tol, add);
  layer2::piercings(a, over_b, b, true, add);
  layer2::piercings(b, over_a, a, false, add);
  if (out.size() == first) return;
  const ContactKind kind = kind_by_extent(out.data() + first, out.data() + out.size(), reach);
  for (std::size_t i = first; i < out.size(); ++i) out[i].kind = kind;
}

}  // namespace tactus::sim
