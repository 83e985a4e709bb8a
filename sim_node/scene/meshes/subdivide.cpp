#include "sim_node/scene/meshes/subdivide.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "sim_node/scene/meshes/mesh_parts.h"

namespace tactus::sim {
namespace {

using Index = std::size_t;
using Edge = std::pair<int, int>;  // of points, the smaller first

Edge edge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

struct Sides {
  std::vector<Index> corners;  // opposite corners, one per triangle at the edge
  bool sharp = false;
  int middle = -1;
};

// Triangles of welded points, with attributes of their corners.
struct Surface {
  std::vector<Eigen::Vector3d> points;
  std::vector<int> corners;                // point indices, three per triangle
  std::vector<Eigen::Vector2f> texcoords;  // per corner, or empty
  std::map<Edge, Sides> edges;

  Index next(Index c) const { return c % 3 == 2 ? c - 2 : c + 1; }
  int point(Index c) const { return corners[c]; }

  void find_edges() {
    edges.clear();
    for (Index c = 0; c < corners.size(); ++c)
      edges[edge(point(next(c)), point(next(next(c))))].corners.push_back(c);
    for (auto& [e, sides] : edges) sides.sharp = sides.corners.size() != 2;
  }
};

Surface weld(const TriangleMesh& mesh) {
  Surface s;
  std::map<std::array<double, 3>, int> known;
  std::vector<int> point_of;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    const auto [at, is_new] = known.try_emplace({v.x(), v.y(), v.z()}, static_cast<int>(s.points.size()));
    if (is_new) s.points.push_back(v);
    point_of.push_back(at->second);
  }
  const auto vertex = [&](Index c) { return static_cast<Index>(mesh.indices[c]); };
  for (Index t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const int p[3] = {point_of[vertex(t)], point_of[vertex(t + 1)], point_of[vertex(t + 2)]};
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) continue;
    for (Index k = 0; k < 3; ++k) {
      s.corners.push_back(p[k]);
      if (!mesh.texcoords.empty()) s.texcoords.push_back(mesh.texcoords[vertex(t + k)]);
    }
  }
  s.find_edges();
  // An edge is sharp where its two sides have different normals.
  std::map<std::pair<int, Index>, Eigen::Vector3d> normal;  // of a point in a triangle
  Index kept = 0;
  for (Index t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const int p[3] = {point_of[vertex(t)], point_of[vertex(t + 1)], point_of[vertex(t + 2)]};
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) continue;
    for (Index k = 0; k < 3; ++k) normal[{p[k], kept}] = mesh.normals[vertex(t + k)];
    ++kept;
  }
  constexpr double kSame = 1e-4;  // normals in files are rounded; a crease differs far more
  for (auto& [e, sides] : s.edges)
    for (const int p : {e.first, e.second})
      if (sides.corners.size() == 2)
        sides.sharp =
            sides.sharp || (normal[{p, sides.corners[0] / 3}] - normal[{p, sides.corners[1] / 3}]).norm() > kSame;
  return s;
}

// Loop's weight for each of n neighbours.
double beta(int n) {
  const double c = 3.0 / 8 + std::cos(2 * std::numbers::pi / n) / 4;
  return (5.0 / 8 - c * c) / n;
}

std::vector<Eigen::Vector3d> moved_points(const Surface& s) {
  struct Around {
    int neighbours = 0, sharp = 0;
    Eigen::Vector3d sum{0, 0, 0}, sharp_sum{0, 0, 0};
  };
  std::vector<Around> around(s.points.size());
  for (const auto& [e, sides] : s.edges)
    for (const auto& [from, to] : {e, Edge{e.second, e.first}}) {
      Around& a = around[static_cast<Index>(from)];
      const Eigen::Vector3d& p = s.points[static_cast<Index>(to)];
      ++a.neighbours, a.sum += p;
      if (sides.sharp) ++a.sharp, a.sharp_sum += p;
    }
  std::vector<Eigen::Vector3d> moved = s.points;
  for (Index i = 0; i < moved.size(); ++i) {
    const Around& a = around[i];
    if (a.sharp == 2)
      moved[i] = 0.75 * moved[i] + a.sharp_sum / 8;
    else if (a.sharp < 2 && a.neighbours > 0)
      moved[i] += beta(a.neighbours) * (a.sum - a.neighbours * moved[i]);
  }
  return moved;
}

Surface refined(Surface s) {
  Surface out;
  out.points = moved_points(s);
  const auto at = [&](int point) { return s.points[static_cast<Index>(point)]; };
  for (auto& [e, sides] : s.edges) {
    const Eigen::Vector3d ends = at(e.first) + at(e.second);
    sides.middle = static_cast<int>(out.points.size());
    out.points.push_back(
        sides.sharp
            ? Eigen::Vector3d(ends / 2)
            : Eigen::Vector3d(3 * ends / 8 + (at(s.point(sides.corners[0])) + at(s.point(sides.corners[1]))) / 8));
  }
  const auto middle = [&](Index c) {
    return s.edges.at(edge(s.point(c), s.point(s.next(c)))).middle;
  };  // from c to the next corner
  for (Index t = 0; t < s.corners.size(); t += 3) {
    const int p[3] = {s.point(t), s.point(t + 1), s.point(t + 2)},
              m[3] = {middle(t), middle(t + 1), middle(t + 2)};
    out.corners.insert(out.corners.end(),
                       {p[0], m[0], m[2], p[1], m[1], m[0], p[2], m[2], m[1], m[0], m[1], m[2]});
    if (s.texcoords.empty()) continue;
    const Eigen::Vector2f u[3] = {s.texcoords[t], s.texcoords[t + 1], s.texcoords[t + 2]};
    const Eigen::Vector2f n[3] = {(u[0] + u[1]) / 2, (u[1] + u[2]) / 2, (u[2] + u[0]) / 2};
    for (const Eigen::Vector2f& each : {u[0], n[0], n[2], u[1], n[1], n[0], u[2], n[2], n[1], n[0], n[1], n[2]})
      out.texcoords.push_back(each);
  }
  out.find_edges();
  for (const auto& [e, sides] : s.edges)
    if (sides.sharp)
      for (const int end : {e.first, e.second}) out.edges.at(edge(end, sides.middle)).sharp = true;
  return out;
}

// One vertex for each point, each side of its sharp edges and each texture coordinate.
TriangleMesh to_mesh(const Surface& s) {
  std::vector<Index> leader(s.corners.size());
  std::iota(leader.begin(), leader.end(), Index{0});
  const auto find = [&](Index c) {
    while (leader[c] != c) c = leader[c] = leader[leader[c]];
    return c;
  };
  for (const auto& [e, sides] : s.edges) {
    if (sides.sharp) continue;
    for (const Index a : {s.next(sides.corners[0]), s.next(s.next(sides.corners[0]))})
      for (const Index b : {s.next(sides.corners[1]), s.next(s.next(sides.corners[1]))})
        if (s.point(a) == s.point(b)) leader[find(a)] = find(b);
  }
  std::vector<Eigen::Vector3d> sums(s.corners.size(), Eigen::Vector3d::Zero());
  const auto at = [&](Index c) { return s.points[static_cast<Index>(s.point(c))]; };
  for (Index t = 0; t < s.corners.size(); t += 3)
    for (Index k = 0; k < 3; ++k) sums[find(t + k)] += (at(t + 1) - at(t)).cross(at(t + 2) - at(t));
  TriangleMesh mesh;
  std::map<std::pair<Index, std::array<float, 2>>, int> known;
  for (Index c = 0; c < s.corners.size(); ++c) {
    const Eigen::Vector2f u = s.texcoords.empty() ? Eigen::Vector2f(0, 0) : s.texcoords[c];
    const auto [vertex, is_new] =
        known.try_emplace({find(c), {u.x(), u.y()}}, static_cast<int>(mesh.vertices.size()));
    if (is_new) {
      mesh.vertices.push_back(at(c));
      mesh.normals.push_back(sums[find(c)].stableNormalized());
      if (!s.texcoords.empty()) mesh.texcoords.push_back(u);
    }
    mesh.indices.push_back(vertex->second);
  }
  return mesh;
}

}  // namespace

TriangleMesh subdivide(const TriangleMesh& mesh, int times) {
  if (static_cast<double>(mesh.indices.size()) / 3 * std::pow(4, times) > static_cast<double>(kMaxTriangles))
    throw std::runtime_error("it would have more than " + std::to_string(kMaxTriangles) +
                             " triangles: subdivide it less often");
  Surface surface = weld(mesh);
  for (int i = 0; i < times; ++i) surface = refined(std::move(surface));
  return to_mesh(surface);
}

}  // namespace tactus::sim
