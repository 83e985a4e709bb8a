#include "sim_node/collision/gaps/separating_axis.h"

#include <algorithm>

#include "sim_node/collision/gaps/nearest_points.h"

namespace tactus::sim::gaps {

using Eigen::Vector3d;

namespace {

// A later direction replaces an earlier one when its gap is larger by more than this, m. Between equal directions,
// as of aligned cubes, the choice is then stable.
constexpr double kBetter_m = 1e-9;

// Depth up to which an overlap with a triangle is shallow, m. Design value: a hundred times the overlap that a
// solver may leave.
constexpr double kShallow_m = 1e-3;

struct Search {
  const Convex& a;
  const Convex& b;
  const Eigen::Isometry3d& a_from_b;
  SeparatingAxis best;

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

// Face normals of a core, in its frame.
template <class Visit>
void each_face(const Convex& c, Visit&& visit) {
  if (c.core == Core::kBox)
    for (int i = 0; i < 3; ++i) visit(Vector3d(Vector3d::Unit(i)));
  if (c.core == Core::kCylinder) visit(Vector3d(Vector3d::UnitZ()));
  if (c.core != Core::kTriangle) return;
  const Vector3d n = (c.corners_m[1] - c.corners_m[0]).cross(c.corners_m[2] - c.corners_m[0]);
  if (n.norm() > 0) visit(Vector3d(n.normalized()));
}

// Directions of straight edges, or of the lines on a round side.
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

// Direction between centres. Depends on the poses only, also for coincident centres.
Vector3d between_centres(const Eigen::Isometry3d& a_from_b) {
  const Vector3d direction = a_from_b.translation();
  return direction.norm() > 0 ? Vector3d(direction.normalized()) : Vector3d(Vector3d::UnitZ());
}

// Shrinks the cores step by step until they are separated.
void offer_shrunk(Search& s) {
  const double max_shrinkage_m = std::max(s.a.half_m.maxCoeff(), s.b.half_m.maxCoeff());
  double by = std::max(1e-5, -s.best.gap_m / 2);
  for (;; by *= 2) {
    NearestPoints found;
    const Convex a = shrunk(s.a, std::min(by, max_shrinkage_m)), b = shrunk(s.b, std::min(by, max_shrinkage_m));
    if (nearest_points(a, b, s.a_from_b, 1e30, found) == Proximity::kNear)
      return s.offer((found.on_b - found.on_a) / found.distance_m);
    if (by >= max_shrinkage_m) return;
  }
}

// The same as the general search, in a quarter of the time (Gottschalk, Lin and Manocha 1996: the first six axes).
SeparatingAxis best_face_axis_of_boxes(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b) {
  const Eigen::Matrix3d turn = a_from_b.linear(), size = turn.cwiseAbs();
  const Vector3d direction = a_from_b.translation(), direction_b = turn.transpose() * direction;
  const Vector3d of_a = direction.cwiseAbs() - a.half_m - size * b.half_m,
                 of_b = direction_b.cwiseAbs() - b.half_m - size.transpose() * a.half_m;
  SeparatingAxis best;
  for (int i = 0; i < 3; ++i)
    if (of_a[i] > best.gap_m + kBetter_m) best = {(direction[i] < 0 ? -1.0 : 1.0) * Vector3d::Unit(i), of_a[i]};
  for (int i = 0; i < 3; ++i)
    if (of_b[i] > best.gap_m + kBetter_m) best = {(direction_b[i] < 0 ? -1.0 : 1.0) * turn.col(i), of_b[i]};
  return best;
}

void search_faces(Search& s) {
  each_face(s.a, [&](const Vector3d& n) { s.offer_both(n); });
  each_face(s.b, [&](const Vector3d& n) { s.offer_both(s.a_from_b.linear() * n); });
}

}  // namespace

SeparatingAxis best_face_axis(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b) {
  if (a.core == Core::kBox && b.core == Core::kBox) return best_face_axis_of_boxes(a, b, a_from_b);
  Search s{a, b, a_from_b, {}};
  search_faces(s);
  return s.best;
}

SeparatingAxis overlap_axis(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b) {
  Search s{a, b, a_from_b, {}};
  // A triangle is part of a surface. A shallow overlap is resolved along its face normal, since other directions
  // lead into the neighbouring triangle.
  if (b.core == Core::kTriangle) {
    each_face(b, [&](const Vector3d& n) { s.offer_both(a_from_b.linear() * n); });
    if (s.best.gap_m > -kShallow_m) return s.best;
  }
  search_faces(s);
  each_edge(a, [&](const Vector3d& e) {
    each_edge(b, [&](const Vector3d& f) {
      const Vector3d n = e.cross(a_from_b.linear() * f);
      if (n.norm() > 1e-6) s.offer_both(n.normalized());
    });
  });
  const bool round = a.core == Core::kCylinder || b.core == Core::kCylinder;
  if (round || s.best.along.isZero()) offer_shrunk(s);
  if (s.best.along.isZero()) s.offer(between_centres(a_from_b));
  return s.best;
}

}  // namespace tactus::sim::gaps
