#include "sim_node/collision/gaps/parting.h"

#include <algorithm>
#include <cmath>

#include "sim_node/collision/gaps/nearest_points.h"

namespace tactus::sim::gaps {

using Eigen::Vector3d;

namespace {

// A direction is taken instead of one before it when it parts by more than this, m: so that of two that are
// equally good, as of cubes on each other, it is always the same.
constexpr double kBetter_m = 1e-9;

struct Search {
  const Convex& a;
  const Convex& b;
  const Eigen::Isometry3d& a_from_b;
  Parting best;

  double gap_along(const Vector3d& n) const {
    const Vector3d of_b = a_from_b * support(b, a_from_b.linear().transpose() * -n);
    return n.dot(of_b - support(a, n));
  }
  void offer(const Vector3d& n) {
    const double gap = gap_along(n);
    if (gap > best.gap_m + kBetter_m) best = {n, gap};
  }
  void offer_both(const Vector3d& n) {
    offer(n);
    offer(-n);
  }
};

// Directions of the faces of a core, in its frame.
template <class Visit>
void each_face(const Convex& c, Visit&& visit) {
  if (c.core == Core::kBox)
    for (int i = 0; i < 3; ++i) visit(Vector3d(Vector3d::Unit(i)));
  if (c.core == Core::kCylinder) visit(Vector3d(Vector3d::UnitZ()));
  if (c.core != Core::kTriangle) return;
  const Vector3d n = (c.corners_m[1] - c.corners_m[0]).cross(c.corners_m[2] - c.corners_m[0]);
  if (n.norm() > 0) visit(Vector3d(n.normalized()));
}

// Directions of straight edges, or of the lines along a side.
template <class Visit>
void each_edge(const Convex& c, Visit&& visit) {
  if (c.core == Core::kBox)
    for (int i = 0; i < 3; ++i) visit(Vector3d(Vector3d::Unit(i)));
  if (c.core == Core::kCylinder || c.core == Core::kSegment) visit(Vector3d(Vector3d::UnitZ()));
  for (std::size_t i = 0; c.core == Core::kTriangle && i < 3; ++i) {
    const Vector3d e = c.corners_m[(i + 1) % 3] - c.corners_m[i];
    if (e.norm() > 0) visit(Vector3d(e.normalized()));
  }
}

// One that depends on nothing but the poses, for bodies whose middles are in one place.
Vector3d between_middles(const Eigen::Isometry3d& a_from_b) {
  const Vector3d way = a_from_b.translation();
  return way.norm() > 0 ? Vector3d(way.normalized()) : Vector3d(Vector3d::UnitZ());
}

// Cores shrunk by more and more, until they are apart.
void offer_shrunk(Search& s) {
  const double most = std::max(s.a.half_m.maxCoeff(), s.b.half_m.maxCoeff());
  double by = std::max(1e-5, -s.best.gap_m / 2);
  for (;; by *= 2) {
    NearestPoints found;
    const Convex a = shrunk(s.a, std::min(by, most)), b = shrunk(s.b, std::min(by, most));
    if (nearest_points(a, b, s.a_from_b, 1e30, found) == Apart::kNear)
      return s.offer((found.on_b - found.on_a) / found.distance_m);
    if (by >= most) return;
  }
}

// The same as with any cores, in a quarter of the time (Gottschalk, Lin and Manocha 1996: the first six of the
// axes).
Parting over_faces_of_boxes(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b) {
  const Eigen::Matrix3d turn = a_from_b.linear(), size = turn.cwiseAbs();
  const Vector3d way = a_from_b.translation(), way_b = turn.transpose() * way;
  const Vector3d of_a = way.cwiseAbs() - a.half_m - size * b.half_m,
                 of_b = way_b.cwiseAbs() - b.half_m - size.transpose() * a.half_m;
  Parting best;
  for (int i = 0; i < 3; ++i)
    if (of_a[i] > best.gap_m + kBetter_m) best = {(way[i] < 0 ? -1.0 : 1.0) * Vector3d::Unit(i), of_a[i]};
  for (int i = 0; i < 3; ++i)
    if (of_b[i] > best.gap_m + kBetter_m) best = {(way_b[i] < 0 ? -1.0 : 1.0) * turn.col(i), of_b[i]};
  return best;
}

void search_faces(Search& s) {
  each_face(s.a, [&](const Vector3d& n) { s.offer_both(n); });
  each_face(s.b, [&](const Vector3d& n) { s.offer_both(s.a_from_b.linear() * n); });
}

}  // namespace

Parting over_faces(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b) {
  if (a.core == Core::kBox && b.core == Core::kBox) return over_faces_of_boxes(a, b, a_from_b);
  Search s{a, b, a_from_b, {}};
  search_faces(s);
  return s.best;
}

Parting out_of_overlap(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b) {
  Search s{a, b, a_from_b, {}};
  // A triangle is part of a surface: the way out is over its face, or it would lead into the next triangle.
  if (b.core == Core::kTriangle) each_face(b, [&](const Vector3d& n) { s.offer_both(a_from_b.linear() * n); });
  if (!s.best.along.isZero()) return s.best;
  search_faces(s);
  each_edge(a, [&](const Vector3d& e) {
    each_edge(b, [&](const Vector3d& f) {
      const Vector3d n = e.cross(a_from_b.linear() * f);
      if (n.norm() > 1e-6) s.offer_both(n.normalized());
    });
  });
  const bool round = a.core == Core::kCylinder || b.core == Core::kCylinder;
  if (round || s.best.along.isZero()) offer_shrunk(s);
  if (s.best.along.isZero()) s.offer(between_middles(a_from_b));
  return s.best;
}

}  // namespace tactus::sim::gaps
