// Features of two triangles that may face each other within a tolerance, with fast rejection tests: vertices over
// faces, and edges that pass through faces.
#pragma once

#include <algorithm>

#include "sim_node/collision/layers/point_pairs.h"

namespace tactus::sim::layer2 {

// Signed distance of each vertex of one triangle [i] from each edge [j] of the other, in the plane of the other,
// positive inside; zero for degenerate triangles.
using Sides = std::array<Heights, 3>;

inline Sides sides(const Triangle& of, const Triangle& over) {
  Sides s;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) s[i][j] = (of.v[i] - over.v[j]).dot(over.inward[j]);
  return s;
}

// Rejects a triangle whose vertices are all on one side of a plane and further away than the tolerance.
inline bool out_of_reach(const Heights& h, double tolerance_m) {
  const auto [low, high] = std::minmax({h[0], h[1], h[2]});
  return low > tolerance_m || high < -tolerance_m;
}

// The same for the planes through the other's edges, with the other triangle on their inner side.
inline bool out_of_reach(const Sides& s, double tolerance_m) {
  for (std::size_t j = 0; j < 3; ++j)
    if (std::max({s[0][j], s[1][j], s[2][j]}) < -tolerance_m) return true;
  return false;
}

// Both ends are on one side and further away than the tolerance.
inline bool beyond(double from, double to, double tolerance_m) {
  return std::min(from, to) > tolerance_m || std::max(from, to) < -tolerance_m;
}

// Calls add(pair) for the vertices of `of` over the face.
template <class Add>
void vertices_over(const Triangle& of, const Heights& h, const Sides& s, const Triangle& face, bool of_a,
                   double tolerance_m, Add&& add) {
  if (face.normal.isZero()) return;
  for (std::size_t i = 0; i < 3; ++i)
    if (std::abs(h[i]) <= tolerance_m && s[i][0] >= 0 && s[i][1] >= 0 && s[i][2] >= 0)
      add(over_face(of.v[i], face, h[i], of_a));
}

// Calls add(pair) for the vertices of each triangle over the face of the other, and for edges that face each other.
// over_b: heights of a's vertices over b. in_b: their distances from b's edges.
template <class Add>
void vertices_and_edges(const Triangle& a, const Heights& over_b, const Sides& in_b, const Triangle& b,
                        const Heights& over_a, const Sides& in_a, double tolerance_m, Add&& add) {
  vertices_over(a, over_b, in_b, b, true, tolerance_m, add);
  vertices_over(b, over_a, in_a, a, false, tolerance_m, add);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t i1 = (i + 1) % 3;
    if (beyond(over_b[i], over_b[i1], tolerance_m)) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t j1 = (j + 1) % 3;
      if (beyond(over_a[j], over_a[j1], tolerance_m) || beyond(in_b[i][j], in_b[i1][j], tolerance_m) ||
          beyond(in_a[j][i], in_a[j1][i], tolerance_m))
        continue;
      between_edges(a, i, b, j, tolerance_m, add);
    }
  }
}

// Calls add(pair) for the edges of `of` that pass through the face.
template <class Add>
void piercings(const Triangle& of, const Heights& h, const Triangle& face, bool of_a, Add&& add) {
  if (face.normal.isZero()) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (!((h[i] < 0 && h[j] > 0) || (h[i] > 0 && h[j] < 0))) continue;
    const Eigen::Vector3d at = of.v[i] + (of.v[j] - of.v[i]) * (h[i] / (h[i] - h[j]));
    if (!in_prism(at, face)) continue;
    PointPair p = over_face(at, face, 0, of_a);
    p.pierced = true;
    add(p);
  }
}

}  // namespace tactus::sim::layer2
