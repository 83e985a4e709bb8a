#include "sim_node/collision/gaps/mesh_pair.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "sim_node/collision/gaps/convex_pair.h"

namespace tactus::sim::gaps {

using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

// A point closer than this to a triangle lies on it. A point is nearer than another by more than this, m: a million
// times the rounding of a metre.
constexpr double kOn_m = 1e-9;
// Faces within 0.8 degrees have the same normal. Cosine.
constexpr double kSameNormal = 0.9999;
// Depth up to which a vertex behind a face that faces it is an overlap: where an edge passes through a face, and where
// none does, as for boxes of equal size on each other, m. Design values: the overlap of a scene that is placed by eye;
// far less than the thinnest walls.
constexpr double kDeepest_m = kMaxOriented_m, kDeepestUnpierced_m = kMaxOrientedUnpierced_m;
// Triangles face each other when their normals are opposite within 8 degrees. Cosine.
constexpr double kFacing = -0.99;
// A touching pair separates two triangles when no corner is beyond its plane by more than this angle, rad.
constexpr double kBeyond = 1e-3;
// Edges below this angle have no common perpendicular, rad.
constexpr double kParallelEdges = 1e-3;

AlignedBox3d box_of(const Convex& c, const Isometry3d& to, double grown_m) {
  Vector3d half;
  for (int i = 0; i < 3; ++i) {
    const Vector3d d = to.linear().row(i);
    half[i] = d.dot(support(c, d)) + c.round_m + grown_m;
  }
  return {to.translation() - half, to.translation() + half};
}

}  // namespace

double nearer_limit_m(double distance_m, double share) {
  return share * distance_m - std::max(kOn_m, 1e-6 * distance_m);
}

bool leaves_face(const Vector3d& face_normal, const Vector3d& pair_normal) {
  constexpr double kStraight = 1 - 1e-9;  // cosine
  return std::abs(face_normal.dot(pair_normal)) > kStraight;
}

bool nearest_around(const TriangleTree& mesh, const Vector3d& from, const Vector3d& on_mesh, double share) {
  const double limit_m = nearer_limit_m((from - on_mesh).norm(), share);
  const Vector3d on(kOn_m, kOn_m, kOn_m);
  bool nearest = true;
  mesh.each_within({on_mesh - on, on_mesh + on},
                   [&](const Vector3d& a, const Vector3d& b, const Vector3d& c, int) {
                     if (!nearest || (closest_on_triangle(from, a, b, c) - from).norm() >= limit_m) return;
                     nearest = (closest_on_triangle(on_mesh, a, b, c) - on_mesh).norm() > kOn_m;
                   });
  return nearest;
}

void convex_mesh(const Convex& convex, const Isometry3d& pose, const TriangleTree& mesh,
                 const Isometry3d& mesh_pose, double reach_m, std::vector<PointPair>& out) {
  const Isometry3d mesh_from_world = mesh_pose.inverse(Eigen::Isometry), mesh_from_convex = mesh_from_world * pose;
  Convex triangle;
  triangle.core = Core::kTriangle;
  mesh.each_within(box_of(convex, mesh_from_convex, reach_m),
                   [&](const Vector3d& a, const Vector3d& b, const Vector3d& c, int number) {
                     triangle.corners_m = {a, b, c};
                     const std::size_t first = out.size();
                     convex_pair(convex, pose, triangle, mesh_pose, reach_m, out);
                     if (out.size() == first) return;
                     const auto nearest = std::min_element(
                         out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
                         [](const PointPair& x, const PointPair& y) { return x.gap_m < y.gap_m; });
                     const Vector3d from = nearest->on_a_m - convex.round_m * nearest->normal;
                     if (nearest->gap_m + convex.round_m > kOn_m &&
                         !nearest_around(mesh, mesh_from_world * from, mesh_from_world * nearest->on_b_m)) {
                       out.resize(first);
                       over_face(convex, pose, triangle, mesh_pose, reach_m, out);
                     }
                     for (std::size_t i = first; i < out.size(); ++i) out[i].triangle_b = number;
                   });
}

void plane_mesh(const Isometry3d& plane_pose, const TriangleTree& mesh, const Isometry3d& mesh_pose,
                double reach_m, std::vector<PointPair>& out) {
  PointPair p;
  p.normal = plane_pose.linear().col(2).normalized();
  const double offset = p.normal.dot(plane_pose.translation() - mesh_pose.translation());
  const Vector3d n = mesh_pose.linear().transpose() * p.normal;
  mesh.each_corner_below(n, offset + reach_m, [&](const Vector3d& corner, int number) {
    p.gap_m = n.dot(corner) - offset;
    p.on_b_m = mesh_pose * corner;
    p.on_a_m = p.on_b_m - p.gap_m * p.normal;
    p.triangle_b = number;
    out.push_back(p);
  });
}

bool is_contact(const MeshSide& a, const MeshSide& b, const PointPair& p) {
  const bool over_a = leaves_face(a.pose.linear() * a.triangle.normal, p.normal),
             over_b = leaves_face(b.pose.linear() * b.triangle.normal, p.normal);
  const double share = nearer_share(over_a, over_b);
  const auto around = [share](const MeshSide& s, const Vector3d& from, const Vector3d& on) {
    const Isometry3d back = s.pose.inverse(Eigen::Isometry);
    return nearest_around(s.mesh, back * from, back * on, share);
  };
  return (over_a || around(a, p.on_b_m, p.on_a_m)) && (over_b || around(b, p.on_a_m, p.on_b_m));
}

bool are_flush(const Triangle& a, const Isometry3d& pose_a, const Triangle& b, const Isometry3d& pose_b) {
  return (pose_a.linear() * a.normal).dot(pose_b.linear() * b.normal) > kSameNormal;
}

Triangle moved(const Triangle& t, const Isometry3d& pose) {
  Triangle m = t;
  for (Vector3d& v : m.v) v = pose * v;
  m.normal = pose.linear() * t.normal;
  return m;
}

bool orient(const Triangle& a, const Triangle& b, bool pierced, PointPair& p) {
  if (a.normal.isZero() || b.normal.isZero()) return true;
  const double out_of_a = p.normal.dot(a.normal), into_b = -p.normal.dot(b.normal);
  if (a.normal.dot(b.normal) < kFacing && out_of_a < kFacing && into_b < kFacing && p.gap_m <= (pierced ? kDeepest_m : kDeepestUnpierced_m)) {
    p.normal = -p.normal;
    p.gap_m = -p.gap_m;
    return true;
  }
  if (p.gap_m > kOn_m) return true;
  if (out_of_a < -kBeyond || into_b < -kBeyond) return false;
  const auto beyond = [&](const Triangle& t, const Vector3d& on, double side) {
    return std::any_of(std::begin(t.v), std::end(t.v), [&](const Vector3d& v) { return side * p.normal.dot(v - on) > kBeyond * (v - on).norm() + kOn_m; });
  };
  return !beyond(a, p.on_a_m, 1) && !beyond(b, p.on_b_m, -1);
}

// The least translation that separates the two triangles: along a face, or across two edges that cross (the separating
// axes of two triangles). Its direction points out of a and into b. Edges inside a flat face are none of the mesh.
void resolve_piercing(const Triangle& a, const Triangle& b, PointPair& pair) {
  double least = std::numeric_limits<double>::max();
  Vector3d along = Vector3d::UnitZ();
  const auto consider = [&](Vector3d n) {
    const double size = n.norm();
    if (!(size > kParallelEdges)) return;
    n /= size;
    // Along two side faces both ways are possible.
    for (const Vector3d& way : {n, Vector3d(-n)}) {
      if (way.dot(a.normal) < -kBeyond || way.dot(b.normal) > kBeyond) continue;
      double high = -std::numeric_limits<double>::max(), low = -high;
      for (const Vector3d& v : a.v) high = std::max(high, way.dot(v - pair.on_a_m));
      for (const Vector3d& v : b.v) low = std::min(low, way.dot(v - pair.on_a_m));
      if (high - low < least) least = high - low, along = way;
    }
  };
  consider(a.normal);
  consider(-b.normal);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Vector3d x = a.v[(i + 1) % 3] - a.v[i], y = b.v[(j + 1) % 3] - b.v[j];
      if (!a.inner[i] && !b.inner[j] && x.norm() > 0 && y.norm() > 0) consider(x.normalized().cross(y.normalized()));
    }
  pair.normal = along;
  pair.gap_m = least < std::numeric_limits<double>::max() ? -std::max(0.0, least) : 0;
  const Vector3d middle = (pair.on_a_m + pair.on_b_m) / 2;
  pair.on_a_m = middle - pair.gap_m / 2 * pair.normal;
  pair.on_b_m = middle + pair.gap_m / 2 * pair.normal;
  pair.pierced = false;
}

}  // namespace tactus::sim::gaps
