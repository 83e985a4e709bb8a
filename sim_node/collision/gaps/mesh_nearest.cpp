#include "sim_node/collision/gaps/mesh_nearest.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim_node/collision/gaps/mesh_pair.h"
#include "sim_node/collision/layers/pair_features.h"

namespace tactus::sim::gaps {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using layer2::Heights;
using layer2::Sides;

namespace {

// Gap of a pair that is not a contact but removes the duplicates at its position.
constexpr double kNoContact_m = std::numeric_limits<double>::infinity();

// leaves_face() accepts connections whose lateral share of their length is below this.
constexpr double kStraight = 1e-4;

bool nearer_on(const Triangle& t, const Vector3d& from, double limit_m) {
  if (t.normal.isZero()) return false;
  return (closest_on_triangle(from, t.v[0], t.v[1], t.v[2]) - from).squaredNorm() < limit_m * limit_m;
}

// Distances and positions that differ by less are equal, m: a million times the rounding of a metre.
constexpr double kEqual_m = 1e-9;
// First step of the distance, m; each next step doubles it. Design: the reach of a tool at 0.2 m/s, so that only a
// faster tool needs a second step.
constexpr double kFirstStep_m = 0.01;

std::int64_t nanometres(double x_m) { return static_cast<std::int64_t>(std::floor(x_m / kEqual_m + 0.5)); }

int order(const Vector3d& x, const Vector3d& y) {
  for (int k = 0; k < 3; ++k) {
    const std::int64_t at_x = nanometres(x[k]), at_y = nanometres(y[k]);
    if (at_x != at_y) return at_x < at_y ? -1 : 1;
  }
  return 0;
}

// The order of pairs with equal gaps.
bool position_first(const PointPair& x, const PointPair& y) {
  const int by_b = order(x.on_b_m, y.on_b_m);
  return by_b != 0 ? by_b < 0 : order(x.on_a_m, y.on_a_m) < 0;
}

}  // namespace

void marked_pairs(const Triangle& a, double tilt_a, const Triangle& b, double tilt_b, double tol,
                  std::vector<PointPair>& out) {
  const Heights over_b = layer2::heights(a, b);
  if (layer2::out_of_reach(over_b, tol)) return;
  const Heights over_a = layer2::heights(b, a);
  if (layer2::out_of_reach(over_a, tol)) return;
  const Sides in_b = layer2::sides(a, b), in_a = layer2::sides(b, a);
  // A pair is a local minimum on both triangles, or leaves the face of one along its normal.
  const auto off = [](const Sides& s, double by_m) { return layer2::out_of_reach(s, by_m); };
  if ((off(in_b, tilt_b * tol) || off(in_a, tilt_a * tol)) && off(in_b, kStraight * tol) &&
      off(in_a, kStraight * tol))
    return;
  const auto add = [&](const PointPair& p) {
    out.push_back(p);
    const bool out_of_a = leaves_face(a.normal, p.normal), out_of_b = leaves_face(b.normal, p.normal);
    const double limit_m = nearer_limit_m((p.on_a_m - p.on_b_m).norm(), nearer_share(out_of_a, out_of_b));
    if (limit_m > 0 &&
        ((!out_of_a && nearer_on(a, p.on_b_m, limit_m)) || (!out_of_b && nearer_on(b, p.on_a_m, limit_m))))
      out.back().gap_m = kNoContact_m;
  };
  layer2::vertices_and_edges(a, over_b, in_b, b, over_a, in_a, tol, add);
  const auto always = [&](const PointPair& p) { out.push_back(p); };
  layer2::piercings(a, over_b, b, true, always);
  layer2::piercings(b, over_a, a, false, always);
}

bool comes_first(const PointPair& x, const PointPair& y) {
  const std::int64_t gap_x = nanometres(x.gap_m), gap_y = nanometres(y.gap_m);
  return gap_x != gap_y ? gap_x < gap_y : position_first(x, y);
}

// The pairs of triangles that overlap or nearly touch.
void MeshNearest::find_near(const Mesh& a, const Mesh& b, const Isometry3d& b_from_a, double tolerance_m,
                            std::vector<PointPair>& pairs) {
  facing_.find({a.layers.tree, a.cones, a.pose}, {b.layers.tree, b.cones, b.pose}, tolerance_m, leaves_);
  const auto& of_a = a.layers.tree.triangles();
  const auto& of_b = b.layers.tree.triangles();
  Triangle ta;
  int last = -1;
  for (const auto& [i, j] : leaves_) {
    if (i != last) ta = in_frame_of_b(of_a[static_cast<std::size_t>(i)], b_from_a);
    last = i;
    const std::size_t first = pairs.size();
    marked_pairs(ta, a.cones.tilt_sine(i), of_b[static_cast<std::size_t>(j)], b.cones.tilt_sine(j), tolerance_m,
                 pairs);
    for (std::size_t k = first; k < pairs.size(); ++k) pairs[k].triangle_a = i, pairs[k].triangle_b = j;
  }
  layer3_.remove_hashed(pairs);
  pierced_ = std::any_of(pairs.begin(), pairs.end(), [](const PointPair& p) { return p.pierced; });
}

// Lists the pairs with a distance above from_m and up to to_m, nearest first, and moves them to the world frame.
void MeshNearest::list_candidates(const Mesh& a, const Mesh& b, double from_m, double to_m,
                                  std::vector<PointPair>& pairs) {
  candidates_.clear();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    PointPair& p = pairs[k];
    if (p.gap_m == kNoContact_m || !(p.gap_m > from_m) || p.gap_m > to_m) continue;
    p.on_a_m = b.pose * p.on_a_m;
    p.on_b_m = b.pose * p.on_b_m;
    p.normal = b.pose.linear() * p.normal;
    const bool separated = p.pierced;
    if (separated || p.gap_m < kMaxOriented_m) {
      const Triangle ta = moved(a.layers.tree.triangles()[static_cast<std::size_t>(p.triangle_a)], a.pose),
                     tb = moved(b.layers.tree.triangles()[static_cast<std::size_t>(p.triangle_b)], b.pose);
      if (separated)
        resolve_piercing(ta, tb, p);
      else if (!orient(ta, tb, pierced_, p))
        continue;
    }
    candidates_.push_back({nanometres(p.gap_m), static_cast<std::uint32_t>(k), separated});
  }
  std::sort(candidates_.begin(), candidates_.end(), [&](const Candidate& x, const Candidate& y) {
    if (x.gap_nm != y.gap_nm) return x.gap_nm < y.gap_nm;
    const PointPair &p = pairs[x.pair], &q = pairs[y.pair];
    if (position_first(p, q)) return true;
    return !position_first(q, p) && x.pair < y.pair;
  });
}

// Returns whether the search continues.
bool MeshNearest::report(const Mesh& a, const Mesh& b, PairVisitor& visitor,
                         const std::vector<PointPair>& pairs) const {
  for (const Candidate& c : candidates_) {
    const PointPair& p = pairs[c.pair];
    if (visitor.is_redundant(p)) continue;
    const Triangle &ta = a.layers.tree.triangles()[static_cast<std::size_t>(p.triangle_a)],
                   &tb = b.layers.tree.triangles()[static_cast<std::size_t>(p.triangle_b)];
    if (!c.separated && !is_contact({a.tree, a.pose, ta}, {b.tree, b.pose, tb}, p)) continue;
    if (!visitor.visit(p)) return false;
  }
  return true;
}

void MeshNearest::find(const Mesh& a, const Mesh& b, double reach_m, PairVisitor& visitor,
                       std::vector<PointPair>& pairs) {
  const Isometry3d b_from_a = b.pose.inverse(Eigen::Isometry) * a.pose;
  pairs.clear();
  // Triangle by triangle where orient() decides, so that both searches decide on the same triangles. The first
  // step covers that distance, because an overlap counts as nearer than all other pairs.
  double near_m = std::min(reach_m, kMaxOrientedUnpierced_m);
  find_near(a, b, b_from_a, near_m, pairs);
  if (pierced_) {
    pairs.clear();
    near_m = std::min(reach_m, kMaxOriented_m);
    find_near(a, b, b_from_a, near_m, pairs);
  }
  double done_m = -1;
  for (double step_m = std::min(reach_m, kFirstStep_m);; step_m = std::min(reach_m, 2 * step_m)) {
    if (done_m >= 0) pairs.clear();
    features_.find(a.features, b.features, b_from_a, std::max(near_m - kEqual_m, done_m), step_m, pairs);
    list_candidates(a, b, done_m, step_m, pairs);
    if (!report(a, b, visitor, pairs) || step_m >= reach_m) return;
    done_m = step_m;
  }
}

}  // namespace tactus::sim::gaps
