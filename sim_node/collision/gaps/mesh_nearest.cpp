#include "sim_node/collision/gaps/mesh_nearest.h"

#include <algorithm>
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

Triangle in_frame_of_b(const Triangle& t, const Isometry3d& motion) {
  Triangle m = moved(t, motion);
  for (int i = 0; i < 3; ++i) m.inward[i] = motion.linear() * t.inward[i];
  return m;
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

void MeshNearest::find(const Mesh& a, const Mesh& b, double reach_m, PairVisitor& visitor,
                       std::vector<PointPair>& pairs) {
  pairs.clear();
  facing_.find({a.layers.tree, a.cones, a.pose}, {b.layers.tree, b.cones, b.pose}, reach_m, leaves_);
  const auto& of_a = a.layers.tree.triangles();
  const auto& of_b = b.layers.tree.triangles();
  const Isometry3d b_from_a = b.pose.inverse(Eigen::Isometry) * a.pose;
  Triangle ta;
  int last = -1;
  for (const auto& [i, j] : leaves_) {
    if (i != last) ta = in_frame_of_b(of_a[static_cast<std::size_t>(i)], b_from_a);
    last = i;
    const std::size_t first = pairs.size();
    marked_pairs(ta, a.cones.tilt_sine(i), of_b[static_cast<std::size_t>(j)], b.cones.tilt_sine(j), reach_m,
                 pairs);
    for (std::size_t k = first; k < pairs.size(); ++k) pairs[k].triangle_a = i, pairs[k].triangle_b = j;
  }
  layer3_.remove_hashed(pairs);
  const auto triangles = [&](const PointPair& p) {
    return std::pair<const Triangle&, const Triangle&>(of_a[static_cast<std::size_t>(p.triangle_a)],
                                                       of_b[static_cast<std::size_t>(p.triangle_b)]);
  };
  candidates_.clear();
  const bool pierced = std::any_of(pairs.begin(), pairs.end(), [](const PointPair& p) { return p.pierced; });
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    PointPair& p = pairs[k];
    if (p.gap_m == kNoContact_m) continue;
    p.on_a_m = b.pose * p.on_a_m;
    p.on_b_m = b.pose * p.on_b_m;
    p.normal = b.pose.linear() * p.normal;
    const bool separated = p.pierced;
    if (separated)
      resolve_piercing(moved(triangles(p).first, a.pose), moved(triangles(p).second, b.pose), p);
    else if (p.gap_m < kMaxOriented_m && !orient(moved(triangles(p).first, a.pose), moved(triangles(p).second, b.pose), pierced, p))
      continue;
    candidates_.push_back({p.gap_m, static_cast<std::uint32_t>(k), separated});
  }
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& x, const Candidate& y) { return x.gap_m != y.gap_m ? x.gap_m < y.gap_m : x.pair < y.pair; });
  for (const Candidate& t : candidates_) {
    const PointPair& p = pairs[t.pair];
    if (visitor.is_redundant(p)) continue;
    if (!t.separated && !is_contact({a.tree, a.pose, triangles(p).first}, {b.tree, b.pose, triangles(p).second}, p))
      continue;
    if (!visitor.visit(p)) return;
  }
}

}  // namespace tactus::sim::gaps
