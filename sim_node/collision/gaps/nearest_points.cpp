#include "sim_node/collision/gaps/nearest_points.h"

#include <algorithm>
#include <limits>

namespace tactus::sim::gaps {
namespace {

using Eigen::Vector3d;

// Iteration limit. Curved cores converge by a share per iteration; polytopes end within ten.
constexpr int kMaxRounds = 100;
// Convergence: the improvement that a further iteration could bring, as a share of the squared distance. 1e-12 of it
// is 5e-13 of the distance.
constexpr double kSettled = 1e-12;

struct Corner {
  Vector3d at, on_a, on_b;  // at = on_b - on_a
  double share = 0;
};

struct Simplex {
  Corner corner[4];
  int count = 0;

  Vector3d point() const {
    Vector3d p(0, 0, 0);
    for (int i = 0; i < count; ++i) p += corner[i].share * corner[i].at;
    return p;
  }
  void keep(std::initializer_list<int> which) {
    Corner kept[4];
    int n = 0;
    for (const int i : which) kept[n++] = corner[i];
    for (int i = 0; i < n; ++i) corner[i] = kept[i];
    count = n;
  }
};

struct Shares {
  double u, v, w;
  double squared;  // squared distance of the origin from that point
};

// Weight of b for the point on the line from a to b that is nearest to the origin.
double along_edge(const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  return length2 > 0 ? std::clamp(-a.dot(ab) / length2, 0.0, 1.0) : 0.0;
}

// Weights of the point of a triangle nearest to the origin.
Shares of_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  // Areas come from cross products with an edge. On a rim the corners come so near to each other that products of
  // lengths (Ericson 2005, Real-Time Collision Detection, 5.1.5) would be lost in rounding.
  const Vector3d ab = b - a, bc = c - b, ca = a - c, n = ab.cross(-ca);
  const double va = n.dot(b.cross(bc)), vb = n.dot(c.cross(ca)), vc = n.dot(a.cross(ab));
  if (va > 0 && vb > 0 && vc > 0) {
    const double scale = 1 / (va + vb + vc), u = va * scale, v = vb * scale, w = vc * scale;
    return {u, v, w, (u * a + v * b + w * c).squaredNorm()};
  }
  const double t = along_edge(a, b), r = along_edge(b, c), s = along_edge(c, a);
  const double on_ab = (a + t * ab).squaredNorm(), on_bc = (b + r * bc).squaredNorm(),
               on_ca = (c + s * ca).squaredNorm();
  if (on_ab <= on_bc && on_ab <= on_ca) return {1 - t, t, 0, on_ab};
  return on_bc <= on_ca ? Shares{0, 1 - r, r, on_bc} : Shares{s, 0, 1 - s, on_ca};
}

void reduce_segment(Simplex& s) {
  const double t = along_edge(s.corner[0].at, s.corner[1].at);
  if (t <= 0)
    s.keep({0});
  else if (t >= 1)
    s.keep({1});
  s.corner[0].share = s.count == 2 ? 1 - t : 1;
  s.corner[1].share = t;
}

void take(Simplex& s, int i, int j, int k, const Shares& shares) {
  s.keep({i, j, k});
  s.corner[0].share = shares.u, s.corner[1].share = shares.v, s.corner[2].share = shares.w;
  int n = 0;
  for (int c = 0; c < 3; ++c)
    if (s.corner[c].share > 0) s.corner[n++] = s.corner[c];
  s.count = n;
}

// Returns false when the origin is inside. outside: the origin is known to be outside, which a flat tetrahedron
// cannot decide.
bool reduce_tetrahedron(Simplex& s, bool outside) {
  static constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
  Shares best{0, 0, 0, std::numeric_limits<double>::max()};
  int best_face = -1;
  for (int f = 0; f < 4; ++f) {
    const Vector3d &a = s.corner[kFaces[f][0]].at, &b = s.corner[kFaces[f][1]].at, &c = s.corner[kFaces[f][2]].at,
                   &other = s.corner[kFaces[f][3]].at;
    const Vector3d n = (b - a).cross(c - a);
    const double of_other = n.dot(other - a), of_origin = -n.dot(a);
    if (of_other * of_origin > 0 && !outside) continue;
    const Shares shares = of_triangle(a, b, c);
    if (shares.squared < best.squared) best = shares, best_face = f;
  }
  if (best_face < 0) return false;
  take(s, kFaces[best_face][0], kFaces[best_face][1], kFaces[best_face][2], best);
  return true;
}

bool reduce(Simplex& s, bool outside) {
  switch (s.count) {
    case 1: s.corner[0].share = 1; return true;
    case 2: reduce_segment(s); return true;
    case 3: take(s, 0, 1, 2, of_triangle(s.corner[0].at, s.corner[1].at, s.corner[2].at)); return true;
    default: return reduce_tetrahedron(s, outside);
  }
}

}  // namespace

Proximity nearest_points(const Convex& a, const Convex& b, const Eigen::Isometry3d& a_from_b, double reach_m,
                     NearestPoints& out) {
  const Eigen::Matrix3d turn = a_from_b.linear();
  const auto furthest = [&](const Vector3d& d) {  // support point of b - a
    Corner c;
    c.on_a = support(a, -d);
    c.on_b = a_from_b * support(b, turn.transpose() * d);
    c.at = c.on_b - c.on_a;
    return c;
  };
  Vector3d v = a_from_b.translation();
  if (b.core == Core::kTriangle) v = a_from_b * ((b.corners_m[0] + b.corners_m[1] + b.corners_m[2]) / 3);
  if (v.squaredNorm() == 0) v = Vector3d::UnitX();
  Simplex simplex;
  double squared = std::numeric_limits<double>::max();
  for (int round = 0; round < kMaxRounds; ++round) {
    const Corner next = furthest(-v);
    const double along = v.dot(next.at), v2 = v.squaredNorm();
    if (along > 0 && along * along > reach_m * reach_m * v2) return Proximity::kFar;
    if (simplex.count > 0 && v2 - along <= kSettled * v2) break;
    bool known = false;
    for (int i = 0; i < simplex.count; ++i) known |= simplex.corner[i].at == next.at;
    if (known) break;
    const Simplex before = simplex;
    simplex.corner[simplex.count++] = next;
    // When even the support points along v do not meet, a plane normal to v separates the cores.
    if (!reduce(simplex, along > 0)) return Proximity::kTouching;
    v = simplex.point();
    const double now = v.squaredNorm();
    if (now <= kTouching_m * kTouching_m) return Proximity::kTouching;
    if (now >= squared) {  // rounding: no further progress
      if (before.count > 0 && now > squared) simplex = before;
      break;
    }
    squared = now;
  }
  out.on_a.setZero(), out.on_b.setZero();
  for (int i = 0; i < simplex.count; ++i) {
    out.on_a += simplex.corner[i].share * simplex.corner[i].on_a;
    out.on_b += simplex.corner[i].share * simplex.corner[i].on_b;
  }
  out.distance_m = (out.on_b - out.on_a).norm();
  if (out.distance_m <= kTouching_m) return Proximity::kTouching;
  return out.distance_m > reach_m ? Proximity::kFar : Proximity::kNear;
}

}  // namespace tactus::sim::gaps
