#include "sim_node/collision/layers/inner_edges.h"

#include <catch2/catch.hpp>

#include "tests/sim_node/support/meshes.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

int inner_edges(const std::vector<Triangle>& triangles) {
  int count = 0;
  for (const Triangle& t : triangles)
    for (const bool inner : t.inner) count += inner;
  return count;
}

int inner_edges(const Soup& s) { return inner_edges(ObbTree(s.vertices, s.indices).triangles()); }

}  // namespace

TEST_CASE("The diagonals of a box are inside its faces, and no edge of a round body is") {
  CHECK(inner_edges(box({0.3, 0.2, 0.1})) == 12);
  CHECK(inner_edges(icosphere(1, 0.1)) == 0);
}

TEST_CASE("Corners with equal coordinates are one corner") {
  Soup soup = box({0.3, 0.2, 0.1});
  std::vector<Vector3d> own;
  for (const int i : soup.indices) own.push_back(soup.vertices[static_cast<std::size_t>(i)]);
  std::vector<int> order(own.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  CHECK(inner_edges(ObbTree(own, order).triangles()) == 12);
}

TEST_CASE("An edge of three triangles is an edge of the surface") {
  const std::vector<Vector3d> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
  CHECK(inner_edges(ObbTree(corners, std::vector<int>{0, 1, 2, 0, 3, 1}).triangles()) == 2);
  CHECK(inner_edges(ObbTree(corners, std::vector<int>{0, 1, 2, 0, 3, 1, 0, 1, 4}).triangles()) == 0);
}
