#include "sim_node/collision/gaps/normal_cones.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace tactus::sim::gaps {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// What is nearest to within a millionth of its distance is so off its normal; and what rounding to float adds,
// rad.
constexpr double kSlack_rad = 0.02;
// Wider cones tell nothing, rad.
constexpr double kWidest_rad = 1.4;
// A triangle less high than this bends its surface as it likes within that millionth, m: a hundredth of a reach of
// 10 mm has to fit.
constexpr double kLeastHeight_m = 1e-5;

struct Wide {  // axis and half angle
  Vector3d axis{0, 0, 1};
  double rad = 4;
  double lean = 1;  // of a triangle
};

double angle(const Vector3d& x, const Vector3d& y) { return std::atan2(x.cross(y).norm(), x.dot(y)); }

NormalCone cone_of(const Wide& w) {
  if (w.rad > kWidest_rad) return {};
  return {w.axis.cast<float>(), static_cast<float>(std::cos(w.rad)), static_cast<float>(std::sin(w.rad))};
}

Wide around(const std::vector<Wide>& parts) {
  Wide w{Vector3d::Zero(), 0};
  for (const Wide& p : parts) w.axis += p.axis;
  if (!(w.axis.norm() > 1e-6)) return {};
  w.axis.normalize();
  for (const Wide& p : parts) w.rad = std::max(w.rad, p.rad + angle(w.axis, p.axis));
  return w.rad > kWidest_rad ? Wide{} : w;
}

double least_height_m(const Triangle& t) {
  double longest = 0;
  for (int i = 0; i < 3; ++i) longest = std::max(longest, (t.v[(i + 1) % 3] - t.v[i]).norm());
  return longest > 0 ? (t.v[1] - t.v[0]).cross(t.v[2] - t.v[0]).norm() / longest : 0;
}

// Of each triangle; of one at a border, or where more than two meet at an edge, nothing is known.
std::vector<Wide> of_triangles(const std::vector<Triangle>& triangles) {
  std::map<std::array<double, 3>, int> numbers;
  std::vector<std::array<int, 3>> corners;
  std::map<std::pair<int, int>, int> edges;
  for (const Triangle& t : triangles) {
    std::array<int, 3>& c = corners.emplace_back();
    for (std::size_t i = 0; i < 3; ++i)
      c[i] = numbers.try_emplace({t.v[i].x(), t.v[i].y(), t.v[i].z()}, static_cast<int>(numbers.size()))
                 .first->second;
    for (std::size_t i = 0; i < 3; ++i) ++edges[std::minmax(c[i], c[(i + 1) % 3])];
  }
  std::vector<std::vector<int>> stars(numbers.size());
  std::vector<bool> open(numbers.size(), false);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const int c = corners[t][i], next = corners[t][(i + 1) % 3];
      stars[static_cast<std::size_t>(c)].push_back(static_cast<int>(t));
      const bool whole = c != next && edges[std::minmax(c, next)] == 2;
      if (!whole) open[static_cast<std::size_t>(c)] = open[static_cast<std::size_t>(next)] = true;
    }
  std::vector<Wide> cones;
  std::vector<Wide> parts;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    parts.clear();
    bool known = true;
    for (const int c : corners[t]) {
      known = known && !open[static_cast<std::size_t>(c)];
      for (const int n : stars[static_cast<std::size_t>(c)]) {
        const Triangle& near = triangles[static_cast<std::size_t>(n)];
        known = known && !near.normal.isZero() && least_height_m(near) > kLeastHeight_m;
        parts.push_back({near.normal, kSlack_rad});
      }
    }
    Wide& cone = cones.emplace_back(known ? around(parts) : Wide{});
    if (!known) continue;
    double most = 0;
    for (const Wide& p : parts) most = std::max(most, angle(p.axis, triangles[t].normal) + kSlack_rad);
    if (most < M_PI / 2) cone.lean = std::sin(most);
  }
  return cones;
}

}  // namespace

NormalCones::NormalCones(const ObbTree& tree) : cones_(tree.nodes().size() * kLanes) {
  const std::vector<Wide> leaves = of_triangles(tree.triangles());
  for (const Wide& w : leaves) leans_.push_back(w.lean);
  std::vector<Wide> of_node(tree.nodes().size());
  std::vector<Wide> parts;
  // Children come after their parents.
  for (std::size_t n = tree.nodes().size(); n-- > 0;) {
    parts.clear();
    const WideNode& node = tree.nodes()[n];
    for (int lane = 0; lane < node.count; ++lane) {
      const int child = node.child[lane];
      parts.push_back(child < 0 ? leaves[static_cast<std::size_t>(~child)]
                                : of_node[static_cast<std::size_t>(child)]);
      cones_[n * kLanes + static_cast<std::size_t>(lane)] = cone_of(parts.back());
    }
    const bool known = std::all_of(parts.begin(), parts.end(), [](const Wide& p) { return p.rad <= kWidest_rad; });
    of_node[n] = known ? around(parts) : Wide{};
  }
}

}  // namespace tactus::sim::gaps
