#include "sim_node/scene/meshes/subdivide.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim_node/model/triangles.h"

using namespace tactus::sim;
using Eigen::Vector3d;

namespace {

// Of radius 1, with shared vertices.
TriangleMesh icosahedron() {
  const double g = std::numbers::phi;
  TriangleMesh m;
  for (const Vector3d& v : {Vector3d(-1, g, 0),
                            {1, g, 0},
                            {-1, -g, 0},
                            {1, -g, 0},
                            {0, -1, g},
                            {0, 1, g},
                            {0, -1, -g},
                            {0, 1, -g},
                            {g, 0, -1},
                            {g, 0, 1},
                            {-g, 0, -1},
                            {-g, 0, 1}})
    m.vertices.push_back(v.normalized());
  m.indices = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
               3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
  complete_normals(m);
  return m;
}

// A cube of edge 2 with separate normals for its sides.
TriangleMesh cube() {
  TriangleMesh m;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const int first = static_cast<int>(m.vertices.size());
      Vector3d n = Vector3d::Zero(), u = Vector3d::Zero();
      n[axis] = side, u[(axis + 1) % 3] = 1;
      const Vector3d v = n.cross(u);
      for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        m.vertices.push_back(n + a * u + b * v);
      m.normals.insert(m.normals.end(), 4, n);
      for (const int k : {0, 1, 2, 0, 2, 3}) m.indices.push_back(first + k);
    }
  return m;
}

double loop_beta(int n) { return (5.0 / 8 - std::pow(3.0 / 8 + std::cos(2 * std::numbers::pi / n) / 4, 2)) / n; }

}  // namespace

TEST_CASE("An icosahedron subdivided once matches the masks of Loop") {
  const TriangleMesh m = subdivide(icosahedron(), 1);
  REQUIRE(m.vertices.size() == 42);
  REQUIRE(m.indices.size() == 3 * 80);
  // The five neighbours of a vertex v of radius 1 sum to sqrt(5) v.
  const double old_radius = 1 - 5 * loop_beta(5) + std::sqrt(5.0) * loop_beta(5);
  // Edge between a and b, with c and d opposite: |3 (a + b) + c + d| / 8; a.b = 1/sqrt(5), since they are joined; c
  // and d are not joined: c.d = -1/sqrt(5); each of a, b with each of c, d: 1/sqrt(5).
  const double s = 1 / std::sqrt(5.0);
  const double edge_radius = std::sqrt(9 * (2 + 2 * s) + (2 - 2 * s) + 2 * 3 * 4 * s) / 8;
  int old_ones = 0, new_ones = 0;
  for (const Vector3d& v : m.vertices) {
    old_ones += std::abs(v.norm() - old_radius) < 1e-12;
    new_ones += std::abs(v.norm() - edge_radius) < 1e-12;
  }
  CHECK(old_ones == 12);
  CHECK(new_ones == 30);
}

TEST_CASE("A repeatedly subdivided icosahedron converges to the limit surface of Loop") {
  // Limit of a vertex of valence n: 1 - n c of itself and c of each neighbour, c = 1 / (3 / (8 beta) + n) (Loop 1987,
  // p. 41).
  const double c = 1 / (3 / (8 * loop_beta(5)) + 5), limit = 1 - 5 * c + std::sqrt(5.0) * c;
  double last = 1;
  const TriangleMesh plain = icosahedron();
  for (int times = 1; times <= 4; ++times) {
    const TriangleMesh m = subdivide(plain, times);
    double error = 1;
    for (const Vector3d& v : m.vertices)
      if ((v.normalized() - plain.vertices[0]).norm() < 1e-9) error = std::abs(v.norm() - limit);
    CHECK(error < 0.5 * last);  // by the second eigenvalue of its matrix, below 3/8 + 2/8 cos(72 deg) = 0.453
    last = error;
    if (times < 3) continue;
    // Loop's surface of an icosahedron is not a sphere, but near one: radii within 2 %, normals within 3 degrees.
    double low = 9, high = 0, off = 0;
    for (std::size_t i = 0; i < m.vertices.size(); ++i) {
      low = std::min(low, m.vertices[i].norm()), high = std::max(high, m.vertices[i].norm());
      off = std::max(off, std::acos(std::min(1.0, m.normals[i].dot(m.vertices[i].normalized()))));
    }
    CHECK(high / low < 1.02);
    CHECK(off < 3 * std::numbers::pi / 180);
    const double mean = (low + high) / 2;
    CHECK(integrate(m).volume_m3 == Approx(4 * std::numbers::pi / 3 * mean * mean * mean).epsilon(0.04));
  }
}

TEST_CASE("A subdivided cube keeps its sharp edges") {
  const TriangleMesh m = subdivide(cube(), 3);
  CHECK(m.indices.size() == 3 * 12 * 64);
  const VolumeIntegral v = integrate(m);
  for (std::size_t i = 0; i < m.vertices.size(); ++i) {
    CHECK(m.vertices[i].cwiseAbs().maxCoeff() < 1 + 1e-12);
    // On the side of its normal, one of six.
    CHECK(m.normals[i].cwiseAbs().maxCoeff() > 1 - 1e-12);
    CHECK(m.vertices[i].dot(m.normals[i]) == Approx(1).margin(1e-12));
  }
  // Its edges are straight, so only corners could change the volume, and they stay too.
  CHECK(v.volume_m3 == Approx(8).epsilon(1e-12));
}

TEST_CASE("A subdivided flat sheet keeps plane, border and texture coordinates") {
  TriangleMesh sheet;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      sheet.vertices.emplace_back(x, y, 0.5);
      sheet.normals.emplace_back(0, 0, 1);
      sheet.texcoords.emplace_back(static_cast<float>(x) / 3, static_cast<float>(y) / 3);
    }
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) {
      const int i = y * 4 + x;
      sheet.indices.insert(sheet.indices.end(), {i, i + 1, i + 5, i, i + 5, i + 4});
    }
  const TriangleMesh m = subdivide(sheet, 2);
  CHECK(m.indices.size() == 16 * sheet.indices.size());
  REQUIRE(m.texcoords.size() == m.vertices.size());
  for (std::size_t i = 0; i < m.vertices.size(); ++i) {
    CHECK(m.vertices[i].z() == 0.5);
    CHECK(m.normals[i] == Vector3d(0, 0, 1));
    CHECK((m.vertices[i].head<2>().array() >= -1e-12).all());
    CHECK((m.vertices[i].head<2>().array() <= 3 + 1e-12).all());
    CHECK((m.texcoords[i].array() >= 0).all());
    CHECK((m.texcoords[i].array() <= 1).all());
  }
  double area = 0;
  for (std::size_t t = 0; t < m.indices.size(); t += 3) {
    const auto at = [&](std::size_t k) { return m.vertices[static_cast<std::size_t>(m.indices[t + k])]; };
    const double twice = (at(1) - at(0)).cross(at(2) - at(0)).z();
    CHECK(twice > 0);  // none is turned over
    area += twice / 2;
  }
  // The border converges to a cubic B-spline, which cuts 1/12 off each corner: the integral of (x dy - y dx) along x
  // = 1 - t + t^3/6, y = t^3/6, half of it on each side. Before the limit, less.
  CHECK(area < 9);
  CHECK(area > 9 - 4.0 / 12);
}

TEST_CASE("Vertices at one position are one point") {
  const TriangleMesh shared = icosahedron();
  TriangleMesh soup;
  for (const int i : shared.indices) {
    soup.indices.push_back(static_cast<int>(soup.vertices.size()));
    soup.vertices.push_back(shared.vertices[static_cast<std::size_t>(i)]);
    soup.normals.push_back(shared.normals[static_cast<std::size_t>(i)]);
  }
  CHECK(subdivide(soup, 2).vertices.size() == subdivide(shared, 2).vertices.size());
}

TEST_CASE("A mesh with too many triangles is rejected before subdivision") {
  CHECK_THROWS_WITH(subdivide(icosahedron(), 12), Catch::Contains("more than 1000000 triangles"));
}
