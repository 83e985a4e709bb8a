// Layer 2, both modes: point pairs of a vertex over a face and of two edges.
#pragma once

#include <array>
#include <cmath>

#include "sim_node/collision/layers/segments.h"
#include "sim_node/collision/layers/triangle_pair.h"

namespace tactus::sim::layer2 {

// Below this distance the difference of two points has no direction, m: a million times the rounding of a metre.
inline constexpr double kTouching_m = 1e-10;

using Heights = std::array<double, 3>;

// Heights of the vertices of `of` over the plane of `over`; zero for a degenerate triangle.
inline Heights heights(const Triangle& of, const Triangle& over) {
  Heights h;
  for (std::size_t i = 0; i < 3; ++i) h[i] = (of.v[i] - over.v[0]).dot(over.normal);
  return h;
}

inline bool in_prism(const Eigen::Vector3d& p, const Triangle& t) {
  return (p - t.v[0]).dot(t.inward[0]) >= 0 && (p - t.v[1]).dot(t.inward[1]) >= 0 &&
         (p - t.v[2]).dot(t.inward[2]) >= 0;
}

// A vertex at `height` over a face. of_a: the vertex belongs to a, else to b.
inline PointPair over_face(const Eigen::Vector3d& vertex, const Triangle& face, double height, bool of_a) {
  PointPair p;
  const Eigen::Vector3d foot = vertex - height * face.normal;
  p.on_a_m = of_a ? vertex : foot;
  p.on_b_m = of_a ? foot : vertex;
  // A vertex in the face itself counts as outside.
  p.normal = of_a == (height >= 0) ? Eigen::Vector3d(-face.normal) : face.normal;
  p.gap_m = std::abs(height);
  return p;
}

// Contact normal, from a to b, where two surfaces touch without a gap.
inline Eigen::Vector3d facing(const Triangle& a, const Triangle& b, const Eigen::Vector3d& across) {
  const Eigen::Vector3d direction = a.normal - b.normal;
  const Eigen::Vector3d n = across.norm() > kTouching_m ? across.normalized()
                            : direction.norm() > 1e-6   ? direction.normalized()
                            : a.normal.isZero()         ? Eigen::Vector3d::UnitZ()
                                                        : a.normal;
  return n.dot(direction) < 0 ? Eigen::Vector3d(-n) : n;
}

// Edge i of a against edge j of b.
template <class Add>
void between_edges(const Triangle& a, std::size_t i, const Triangle& b, std::size_t j, double tolerance_m,
                   Add&& add) {
  const Eigen::Vector3d &p = a.v[i], &q = a.v[(i + 1) % 3], &u = b.v[j], &v = b.v[(j + 1) % 3];
  nearest_on_segments(p, q, u, v, tolerance_m, [&](const Eigen::Vector3d& on_a, const Eigen::Vector3d& on_b) {
    const Eigen::Vector3d direction = on_b - on_a;
    const double squared = direction.squaredNorm();
    if (!(squared <= tolerance_m * tolerance_m)) return;
    PointPair pair;
    pair.on_a_m = on_a, pair.on_b_m = on_b;
    pair.gap_m = std::sqrt(squared);
    if (pair.gap_m > kTouching_m)
      pair.normal = direction / pair.gap_m;
    else
      pair.normal = facing(a, b, (q - p).normalized().cross((v - u).normalized()));
    add(pair);
  });
}

}  // namespace tactus::sim::layer2
