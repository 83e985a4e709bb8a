#include "sim_node/collision/gaps/normal_cones.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace tactus::sim::gaps {
namespace {

using Eigen::Vector3d;

// Slack of a cone, rad. Covers the deviation from the normal of a point that is nearest only to within a millionth of
// its distance, and the rounding to float.
constexpr double kSlack_rad = 0.02;
// Wider cones exclude nothing, rad.
constexpr double kWidest_rad = 1.4;
// The normal of a triangle with less height than this is unreliable within that millionth, m. Derived for a reach of
// 10 mm.
constexpr double kMinHeight_m = 1e-5;

struct AngleCone {  // axis and half angle
  Vector3d axis{0, 0, 1};
  double rad = 4;
  double tilt_sine = 1;  // see NormalCones::tilt_sine(); leaves only
};

double angle(const Vector3d& x, const Vector3d& y) { return std::atan2(x.cross(y).norm(), x.dot(y)); }

NormalCone cone_of(const AngleCone& w) {
  if (w.rad > kWidest_rad) return {};
  return {w.axis.cast<float>(), static_cast<float>(std::cos(w.rad)), static_cast<float>(std::sin(w.rad))};
}

AngleCone around(const std::vector<AngleCone>& parts) {
  AngleCone w{Vector3d::Zero(), 0};
  for (const AngleCone& p : parts) w.axis += p.axis;
  if (!(w.axis.norm() > 1e-6)) return {};
  w.axis.normalize();
  for (const AngleCone& p : parts) w.rad = std::max(w.rad, p.rad + angle(w.axis, p.axis));
  return w.rad > kWidest_rad ? AngleCone{} : w;
}

double min_height_m(const Triangle& t) {
  double longest = 0;
  for (int i = 0; i < 3; ++i) longest = std::max(longest, (t.v[(i + 1) % 3] - t.v[i]).norm());
  return longest > 0 ? (t.v[1] - t.v[0]).cross(t.v[2] - t.v[0]).norm() / longest : 0;
}

// Cones of the triangles. Triangles at a border, or at an edge with more than two triangles, get an open cone.
std::vector<AngleCone> of_triangles(const std::vector<Triangle>& triangles) {
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
  std::vector<AngleCone> cones;
  std::vector<AngleCone> parts;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    parts.clear();
    bool known = true;
    for (const int c : corners[t]) {
      known = known && !open[static_cast<std::size_t>(c)];
      for (const int n : stars[static_cast<std::size_t>(c)]) {
        const Triangle& near = triangles[static_cast<std::size_t>(n)];
        known = known && !near.normal.isZero() && min_height_m(near) > kMinHeight_m;
        parts.push_back({near.normal, kSlack_rad});
      }
    }
    AngleCone& cone = cones.emplace_back(known ? around(parts) : AngleCone{});
    if (!known) continue;
    double max_angle_rad = 0;
    for (const AngleCone& p : parts)
      max_angle_rad = std::max(max_angle_rad, angle(p.axis, triangles[t].normal) + kSlack_rad);
    if (max_angle_rad < M_PI / 2) cone.tilt_sine = std::sin(max_angle_rad);
  }
  return cones;
}

}  // namespace

NormalCones::NormalCones(const ObbTree& tree) : cones_(tree.nodes().size() * kLanes) {
  const std::vector<AngleCone> leaves = of_triangles(tree.triangles());
  for (const AngleCone& w : leaves) tilts_.push_back(w.tilt_sine);
  std::vector<AngleCone> of_node(tree.nodes().size());
  std::vector<AngleCone> parts;
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
    const bool known = std::all_of(parts.begin(), parts.end(), [](const AngleCone& p) { return p.rad <= kWidest_rad; });
    of_node[n] = known ? around(parts) : AngleCone{};
  }
}

}  // namespace tactus::sim::gaps
