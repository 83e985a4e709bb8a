#include "visual_node/scene_view/triangles.h"

#include <catch2/catch.hpp>
#include <map>
#include <numbers>

using namespace tactus::visual;
using Eigen::Vector3f;

namespace {

Vector3f corner(const Triangles& t, std::size_t i) { return t.positions[t.indices[i]]; }

// By the divergence theorem; positive only when the triangles face outwards.
double volume(const Triangles& t) {
  double sum = 0;
  for (std::size_t i = 0; i < t.indices.size(); i += 3)
    sum +=
        corner(t, i).cast<double>().dot(corner(t, i + 1).cast<double>().cross(corner(t, i + 2).cast<double>())) /
        6;
  return sum;
}

// Every edge is used once in each direction: no hole, no flipped face.
bool closed(const Triangles& t) {
  const auto key = [](const Vector3f& p) {
    return std::array<long, 3>{std::lround(p.x() * 1e5), std::lround(p.y() * 1e5), std::lround(p.z() * 1e5)};
  };
  std::map<std::pair<std::array<long, 3>, std::array<long, 3>>, int> edges;
  for (std::size_t i = 0; i < t.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = key(corner(t, i + k)), b = key(corner(t, i + (k + 1) % 3));
      ++edges[{a, b}];
      --edges[{b, a}];
    }
  return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; });
}

bool normals_face_outwards(const Triangles& t) {
  for (std::size_t i = 0; i < t.indices.size(); i += 3) {
    const Vector3f face = (corner(t, i + 1) - corner(t, i)).cross(corner(t, i + 2) - corner(t, i));
    for (std::size_t k = 0; k < 3; ++k)
      if (face.dot(t.normals[t.indices[i + k]]) <= 0) return false;
  }
  return std::all_of(t.normals.begin(), t.normals.end(),
                     [](const Vector3f& n) { return std::abs(n.norm() - 1) < 1e-5f; });
}

// A prism of n sides inscribed in a circle has this share of its area.
double inscribed(int n) { return n / (2 * std::numbers::pi) * std::sin(2 * std::numbers::pi / n); }

}  // namespace

TEST_CASE("Solid shapes are closed, face outwards and have the right volume") {
  const double pi = std::numbers::pi;
  SECTION("box") { CHECK(volume(unit_box()) == Approx(1)); }
  SECTION("cylinder") { CHECK(volume(unit_cylinder(24)) == Approx(pi * inscribed(24)).epsilon(1e-5)); }
  // Rings of 15 degrees lose less than (pi / 24)^2 of the share of each dimension: 3 %.
  SECTION("sphere") { CHECK(volume(unit_sphere(24)) == Approx(4.0 / 3 * pi).epsilon(0.03)); }
  SECTION("capsule") {
    CHECK(volume(capsule(0.5, 2, 24)) == Approx(pi * 0.25 * 2 + 4.0 / 3 * pi * 0.125).epsilon(0.03));
  }
  for (const Triangles& t :
       {unit_box(), unit_cylinder(12), unit_sphere(12), unit_sphere(48), capsule(0.2, 0.6, 24)}) {
    CHECK(closed(t));
    CHECK(normals_face_outwards(t));
  }
}

TEST_CASE("A plane faces +z and is also visible from below") {
  const Triangles t = unit_plane();
  CHECK(normals_face_outwards(t));
  CHECK(t.normals[0].isApprox(Vector3f::UnitZ()));
  CHECK(t.two_sided);
}

TEST_CASE("Tangents follow u and binormals follow v on every shape") {
  // Around a ring of n segments, points between two corners differ by up to a turn / n from the tangent at either
  // corner, and by half of it from the tangent in the middle.
  for (const auto& [t, turn] :
       std::vector<std::pair<Triangles, double>>{{unit_box(), 0},
                                                 {unit_plane(), 0},
                                                 {unit_cylinder(40), 2 * std::numbers::pi / 40},
                                                 {unit_sphere(40), 2 * std::numbers::pi / 40},
                                                 {capsule(0.2, 0.6, 40), 2 * std::numbers::pi / 40}}) {
    REQUIRE(t.texcoords.size() == t.positions.size());
    REQUIRE(t.tangents.size() == t.positions.size());
    for (std::size_t i = 0; i < t.positions.size(); ++i) {
      const Vector3f along = t.tangents[i].head<3>();
      REQUIRE(along.norm() == Approx(1).margin(1e-5));
      REQUIRE(along.dot(t.normals[i]) == Approx(0).margin(1e-5));
      REQUIRE(std::abs(t.tangents[i].w()) == 1);
      REQUIRE(t.texcoords[i].minCoeff() >= 0);
      REQUIRE(t.texcoords[i].maxCoeff() <= 1);
    }
    for (std::size_t i = 0; i < t.indices.size(); i += 3) {
      // The position as a function of u and v on this triangle: dP = P_u du + P_v dv along two of its edges.
      const auto uv = [&](std::size_t k) { return t.texcoords[t.indices[i + k]]; };
      Eigen::Matrix2f d;
      d << uv(1) - uv(0), uv(2) - uv(0);
      Eigen::Matrix<float, 3, 2> p;
      p << corner(t, i + 1) - corner(t, i), corner(t, i + 2) - corner(t, i);
      REQUIRE(std::abs(d.determinant()) > 1e-7f);
      const Eigen::Matrix<float, 3, 2> by_uv = p * d.inverse();
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector4f tangent = t.tangents[t.indices[i + k]];
        const Vector3f binormal = tangent.w() * t.normals[t.indices[i + k]].cross(tangent.head<3>());
        REQUIRE(tangent.head<3>().dot(by_uv.col(0).normalized()) >= std::cos(turn) - 1e-4);
        // At a pole the binormals of a ring are those of all longitudes.
        if (p.col(0).norm() > 0) REQUIRE(binormal.dot(by_uv.col(1).normalized()) >= std::cos(1.5 * turn) - 1e-4);
      }
    }
  }
}
