#include <algorithm>

#include "sim_node/collision/layers/point_pairs.h"

namespace tactus::sim {

using Eigen::Vector3d;
using layer2::Heights;

namespace {

// Of each vertex of one triangle [i] inside each edge [j] of the other, in the plane of that; zero where it has
// none.
using Sides = std::array<Heights, 3>;

Sides sides(const Triangle& of, const Triangle& over) {
  Sides s;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) s[i][j] = (of.v[i] - over.v[j]).dot(over.inward[j]);
  return s;
}

// A triangle whose vertices are all on one side of a plane and further away than the tolerance touches nothing in
// it.
bool out_of_reach(const Heights& h, double tolerance_m) {
  const auto [low, high] = std::minmax({h[0], h[1], h[2]});
  return low > tolerance_m || high < -tolerance_m;
}

// The same for the planes that stand on the other's edges, with all of that on their inner side.
bool out_of_reach(const Sides& s, double tolerance_m) {
  for (std::size_t j = 0; j < 3; ++j)
    if (std::max({s[0][j], s[1][j], s[2][j]}) < -tolerance_m) return true;
  return false;
}

// Both ends on one side and further away than the tolerance.
bool beyond(double from, double to, double tolerance_m) {
  return std::min(from, to) > tolerance_m || std::max(from, to) < -tolerance_m;
}

void vertices_over(const Triangle& of, const Heights& h, const Sides& s, const Triangle& face, bool of_a,
                   double tolerance_m, std::vector<PointPair>& out) {
  if (face.normal.isZero()) return;
  for (std::size_t i = 0; i < 3; ++i)
    if (std::abs(h[i]) <= tolerance_m && s[i][0] >= 0 && s[i][1] >= 0 && s[i][2] >= 0)
      out.push_back(layer2::over_face(of.v[i], face, h[i], of_a));
}

// Edges of `of` that pass from one side of the face to the other through it.
void piercings(const Triangle& of, const Heights& h, const Triangle& face, bool of_a,
               std::vector<PointPair>& out) {
  if (face.normal.isZero()) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (!((h[i] < 0 && h[j] > 0) || (h[i] > 0 && h[j] < 0))) continue;
    const Vector3d at = of.v[i] + (of.v[j] - of.v[i]) * (h[i] / (h[i] - h[j]));
    if (!layer2::in_prism(at, face)) continue;
    PointPair p = layer2::over_face(at, face, 0, of_a);
    p.pierced = true;
    out.push_back(p);
  }
}

}  // namespace

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
  if (out_of_reach(over_b, tol)) return;
  const Heights over_a = layer2::heights(b, a);
  if (out_of_reach(over_a, tol)) return;
  const Sides in_b = sides(a, b), in_a = sides(b, a);
  if (out_of_reach(in_b, tol) || out_of_reach(in_a, tol)) return;
  const std::size_t first = out.size();
  vertices_over(a, over_b, in_b, b, true, tol, out);
  vertices_over(b, over_a, in_a, a, false, tol, out);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t i1 = (i + 1) % 3;
    if (beyond(over_b[i], over_b[i1], tol)) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t j1 = (j + 1) % 3;
      if (beyond(over_a[j], over_a[j1], tol) || beyond(in_b[i][j], in_b[i1][j], tol) ||
          beyond(in_a[j][i], in_a[j1][i], tol))
        continue;
      layer2::between_edges(a, i, b, j, tol, [&](const PointPair& p) { out.push_back(p); });
    }
  }
  piercings(a, over_b, b, true, out);
  piercings(b, over_a, a, false, out);
  if (out.size() == first) return;
  const ContactKind kind = kind_by_extent(out.data() + first, out.data() + out.size(), reach);
  for (std::size_t i = first; i < out.size(); ++i) out[i].kind = kind;
}

}  // namespace tactus::sim
