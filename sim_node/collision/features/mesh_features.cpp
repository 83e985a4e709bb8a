#include "sim_node/collision/features/mesh_features.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace tactus::sim::features {
namespace {

using Eigen::Vector3d;

// Wider cones allow all directions, rad.
constexpr double kWidestCone_rad = 1.4;
// Reserve for the bulge of the border of a vertex's region between its corners, rad. It is of the order of
// kDirectionSlack_rad times the square of a corner's distance.
constexpr double kBulge_rad = 0.01;

double least_height_m(const Triangle& t) {
  double longest = 0;
  for (int i = 0; i < 3; ++i) longest = std::max(longest, (t.v[(i + 1) % 3] - t.v[i]).norm());
  return longest > 0 ? (t.v[1] - t.v[0]).cross(t.v[2] - t.v[0]).norm() / longest : 0;
}

double angle_between(const Vector3d& x, const Vector3d& y) { return std::atan2(x.cross(y).norm(), x.dot(y)); }

// The corners of the region of directions that no neighbour excludes: where two of them limit it.
std::vector<Vector3d> region_corners(std::span<const MeshFeatures::Neighbour> around, bool& collinear) {
  std::vector<Vector3d> corners;
  collinear = true;
  for (std::size_t i = 0; i < around.size(); ++i)
    for (std::size_t j = i + 1; j < around.size(); ++j) {
      const Vector3d &x = around[i].along, &y = around[j].along;
      const Vector3d across = x.cross(y);
      const double cosine = x.dot(y), sine = across.norm();
      collinear = collinear && std::abs(cosine) > 0.999;
      if (sine < 1e-6) continue;
      const Vector3d within = kDirectionSlack_rad / (1 + cosine) * (x + y);
      const double rest = 1 - within.squaredNorm();
      if (rest < 0) continue;
      for (const double side : {-1.0, 1.0}) {
        const Vector3d corner = within + side * std::sqrt(rest) / sine * across;
        if (std::all_of(around.begin(), around.end(),
                        [&](const auto& n) { return n.along.dot(corner) <= kDirectionSlack_rad + 1e-9; }))
          corners.push_back(corner);
      }
    }
  return corners;
}

double widest_rad(const std::vector<Vector3d>& corners, const Vector3d& axis, bool both_sides) {
  double most = 0;
  for (const Vector3d& c : corners)
    most = std::max(most, angle_between(axis, both_sides && c.dot(axis) < 0 ? Vector3d(-c) : c));
  return most;
}

}  // namespace

DirectionCone direction_cone(const Vector3d& axis, double half_angle_rad) {
  if (!(half_angle_rad <= kWidestCone_rad)) return {};
  return {axis, std::cos(half_angle_rad), std::sin(half_angle_rad), false};
}

MeshFeatures::MeshFeatures(const std::vector<Triangle>& of) : triangles(of) {
  std::map<std::array<double, 3>, int> numbers;
  std::map<std::pair<int, int>, std::size_t> edge_of;
  std::vector<std::vector<Neighbour>> stars;
  std::vector<std::vector<int>> faces;
  for (std::size_t t = 0; t < of.size(); ++t) {
    std::array<int, 3> c;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d& v = of[t].v[i];
      const auto [at, is_new] = numbers.try_emplace({v.x(), v.y(), v.z()}, static_cast<int>(vertices.size()));
      c[i] = at->second;
      if (!is_new) continue;
      vertices.push_back(v);
      stars.emplace_back();
      faces.emplace_back();
    }
    for (const int v : c) {
      std::vector<int>& at = faces[static_cast<std::size_t>(v)];
      if (at.empty() || at.back() != static_cast<int>(t)) at.push_back(static_cast<int>(t));
    }
    const bool limits = !of[t].normal.isZero() && least_height_m(of[t]) > kMinHeight_m;
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = c[i], to = c[(i + 1) % 3];
      if (from == to) continue;
      const Vector3d way = vertices[static_cast<std::size_t>(to)] - vertices[static_cast<std::size_t>(from)];
      const double length_m = way.norm();
      const Vector3d along = way / length_m;
      const auto [at, is_new] = edge_of.try_emplace(std::minmax(from, to), edges.size());
      if (is_new)
        edges.push_back({static_cast<int>(t),
                         static_cast<int>(i),
                         {from, to},
                         along,
                         length_m,
                         {Vector3d::Zero(), Vector3d::Zero()}});
      if (!limits) continue;
      Edge& e = edges[at->second];
      const bool has_first = !e.inward[0].isZero();
      if (!has_first)
        e.inward[0] = of[t].inward[i];
      else if (e.inward[1].isZero() || e.inward[0].dot(of[t].inward[i]) < e.inward[0].dot(e.inward[1]))
        e.inward[1] = of[t].inward[i];
      // Each edge of a star once: where its first face with a height comes.
      if (has_first) continue;
      stars[static_cast<std::size_t>(from)].push_back({along, length_m});
      stars[static_cast<std::size_t>(to)].push_back({-along, length_m});
    }
  }
  for (const auto& star : stars) {
    first_neighbour.push_back(neighbours.size());
    neighbours.insert(neighbours.end(), star.begin(), star.end());
  }
  first_neighbour.push_back(neighbours.size());
  for (const auto& at : faces) {
    first_triangle.push_back(triangles_at.size());
    triangles_at.insert(triangles_at.end(), at.begin(), at.end());
  }
  first_triangle.push_back(triangles_at.size());
}

int MeshFeatures::triangle_across(int vertex, const Vector3d& direction) const {
  const auto v = static_cast<std::size_t>(vertex);
  const auto facing = [&](int t) {
    return std::abs(triangles[static_cast<std::size_t>(t)].normal.dot(direction));
  };
  int best = triangles_at[first_triangle[v]];
  for (std::size_t i = first_triangle[v] + 1; i < first_triangle[v + 1]; ++i)
    if (facing(triangles_at[i]) < facing(best)) best = triangles_at[i];
  return best;
}

DirectionCone MeshFeatures::cone_of_edge(int edge) const {
  const Edge& e = edges[static_cast<std::size_t>(edge)];
  if (e.inward[0].isZero() || e.inward[1].isZero()) return {};
  const Vector3d in = e.inward[0] + e.inward[1];
  const double half_rad = (M_PI - angle_between(e.inward[0], e.inward[1])) / 2;
  const Vector3d axis = in.norm() > 1e-3 ? Vector3d(-in.normalized()) : Vector3d(e.inward[0].cross(e.along));
  return direction_cone(axis.normalized(), half_rad + kDirectionSlack_rad + 1e-3);
}

DirectionCone MeshFeatures::cone_of_vertex(int vertex) const {
  const auto star = around(vertex);
  if (star.size() < 3) return {};
  bool collinear = false;
  const std::vector<Vector3d> corners = region_corners(star, collinear);
  Vector3d mean = Vector3d::Zero(), in = Vector3d::Zero();
  for (const Neighbour& n : star) in += n.along / static_cast<double>(star.size());
  if (corners.empty()) {
    DirectionCone none;
    // A region without corners is empty, or bounded by neighbours on one line.
    none.empty = !collinear;
    return none;
  }
  for (const Vector3d& c : corners) mean += c / static_cast<double>(corners.size());
  if (mean.norm() > 0.1) {
    const DirectionCone one_side =
        direction_cone(mean.normalized(), widest_rad(corners, mean.normalized(), false) + kBulge_rad);
    if (one_side.cosine > 0) return one_side;
  }
  // A nearly flat star: directions to both sides, close to one line.
  Vector3d line = Vector3d::Zero();
  for (const Vector3d& c : corners) line += c.dot(corners[0]) < 0 ? Vector3d(-c) : c;
  line.normalize();
  const double rad = widest_rad(corners, line, true);
  return in.norm() < 0.2 && rad < 0.5 ? direction_cone(line, rad + kBulge_rad) : DirectionCone{};
}

}  // namespace tactus::sim::features
