#include "sim_node/collision/layers/inner_edges.h"

#include <algorithm>
#include <array>

namespace tactus::sim {
namespace {

constexpr double kOneFace = 1 - 1e-9;  // cosine: 0.003 degrees

struct SharedEdge {
  std::array<double, 6> ends;  // the smaller corner first
  std::size_t triangle = 0;
  int edge = 0;
};

std::array<double, 3> corner(const Triangle& t, int i) { return {t.v[i].x(), t.v[i].y(), t.v[i].z()}; }

}  // namespace

void mark_inner_edges(std::vector<Triangle>& triangles) {
  std::vector<SharedEdge> edges;
  edges.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax({corner(triangles[t], i), corner(triangles[t], (i + 1) % 3)});
      edges.push_back({{a[0], a[1], a[2], b[0], b[1], b[2]}, t, i});
    }
  std::sort(edges.begin(), edges.end(), [](const SharedEdge& x, const SharedEdge& y) { return x.ends < y.ends; });
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    while (end < edges.size() && edges[end].ends == edges[i].ends) ++end;
    if (end - i != 2) continue;
    Triangle &a = triangles[edges[i].triangle], &b = triangles[edges[i + 1].triangle];
    if (a.normal.dot(b.normal) > kOneFace) a.inner[edges[i].edge] = b.inner[edges[i + 1].edge] = true;
  }
}

}  // namespace tactus::sim
