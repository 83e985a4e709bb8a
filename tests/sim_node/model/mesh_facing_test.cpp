// Tests of the side that the triangles of a mesh face.
#include <algorithm>
#include <catch2/catch.hpp>

#include "sim_node/model/mesh_solid.h"
#include "tests/sim_node/support/meshes.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

TriangleMesh soup_mesh(const Soup& soup) {
  TriangleMesh mesh{soup.vertices, {}, soup.indices};
  complete_normals(mesh);
  return mesh;
}

void turn_one(TriangleMesh& mesh, std::size_t triangle) { std::swap(mesh.indices[3 * triangle + 1], mesh.indices[3 * triangle + 2]); }

void turn_all(TriangleMesh& mesh) {
  for (std::size_t t = 0; 3 * t < mesh.indices.size(); ++t) turn_one(mesh, t);
  for (Vector3d& n : mesh.normals) n = -n;
}

void move(Soup& soup, const Eigen::Isometry3d& pose) {
  for (Vector3d& v : soup.vertices) v = pose * v;
}

bool same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.normals == b.normals && a.indices == b.indices;
}

Soup square_plate() {  // faces up
  Soup s;
  s.add({0, 0, 0}, {1, 0, 0}, {1, 1, 0});
  s.add({0, 0, 0}, {1, 1, 0}, {0, 1, 0});
  return s;
}

}  // namespace

TEST_CASE("A mesh that is inside out becomes the same mesh as the right one, at any pose and with any triangles turned") {
  Random random(4);
  for (int round = 0; round < 80; ++round) {
    INFO(round);
    Soup soup = lumpy_sphere(1 + round % 3, uniform(random, 1e-3, 10), random());
    if (round % 4 == 1) soup.add(icosphere(1, 0.5), random_pose(random, 30));  // two bodies
    move(soup, random_pose(random, 20));
    const TriangleMesh right = soup_mesh(soup);
    TriangleMesh same = right;
    CHECK_FALSE(turn_outwards(same).any());
    CHECK(same_mesh(same, right));
    TriangleMesh other = right;
    if (round % 2) turn_all(other);
    const std::size_t count = right.indices.size() / 3;
    std::size_t turned = round % 2 ? count : 0;
    if (round % 3 == 0)
      for (std::size_t t = 0; t < count; ++t)
        if (random() % 5 == 0) {
          turn_one(other, t);
          ++turned;
        }
    const TurnedTriangles found = turn_outwards(other);
    if (round % 3 != 0) CHECK(found.turned == turned);
    CHECK(found.repeated == 0);
    CHECK(other.indices == right.indices);
    if (round % 3 != 0) CHECK(same_mesh(other, right));
  }
}

TEST_CASE("The walls of a cavity face it, whether the mesh is right or inside out") {
  Random random(5);
  for (int round = 0; round < 20; ++round) {
    TriangleMesh shell = soup_mesh(icosphere(2, 1)), cavity = soup_mesh(lumpy_sphere(1, 0.3, random()));
    turn_all(cavity);
    TriangleMesh right = shell;
    const int first = static_cast<int>(right.vertices.size());
    right.vertices.insert(right.vertices.end(), cavity.vertices.begin(), cavity.vertices.end());
    right.normals.insert(right.normals.end(), cavity.normals.begin(), cavity.normals.end());
    for (const int i : cavity.indices) right.indices.push_back(first + i);
    TriangleMesh same = right, other = right;
    CHECK_FALSE(turn_outwards(same).any());
    turn_all(other);
    CHECK(turn_outwards(other).shells == 2);
    CHECK(same_mesh(other, right));
  }
}

TEST_CASE("An open surface keeps the side that it faces, and single triangles follow their neighbours") {
  for (const bool down : {false, true}) {
    TriangleMesh mesh = soup_mesh(square_plate());
    if (down) turn_all(mesh);
    const TriangleMesh before = mesh;
    CHECK_FALSE(turn_outwards(mesh).any());
    CHECK(same_mesh(mesh, before));
  }
  // A box without its lid, seen from inside: the walls of a room.
  Soup box = icosphere(2, 1);
  box.indices.resize(box.indices.size() - 3 * 40);
  for (const bool inwards : {false, true}) {
    TriangleMesh mesh = soup_mesh(box);
    if (inwards) turn_all(mesh);
    const TriangleMesh before = mesh;
    CHECK_FALSE(turn_outwards(mesh).any());
    turn_one(mesh, 7);
    CHECK(turn_outwards(mesh).turned == 1);
    CHECK(mesh.indices == before.indices);
  }
}

TEST_CASE("Triangles that exist twice are left out of a closed mesh, and stay in a sheet with two sides") {
  const Soup ball = icosphere(1, 1);
  TriangleMesh right = soup_mesh(ball), twice = right;
  for (std::size_t t = 0; t < right.indices.size() / 3; ++t)
    for (const std::size_t k : {0u, 2u, 1u}) twice.indices.push_back(right.indices[3 * t + k]);
  const TurnedTriangles found = turn_outwards(twice);
  CHECK(found.repeated == right.indices.size() / 3);
  CHECK(twice.indices == right.indices);
  Soup both = square_plate();
  const std::size_t corners = both.indices.size();
  for (std::size_t i = 0; i < corners; i += 3)
    for (const std::size_t k : {0u, 2u, 1u}) both.indices.push_back(both.indices[i + k]);
  TriangleMesh sheet = soup_mesh(both);
  const TriangleMesh before = sheet;
  CHECK_FALSE(turn_outwards(sheet).any());
  CHECK(same_mesh(sheet, before));
}

TEST_CASE("A surface with one side, and shells that meet in an edge, keep or get consistent faces") {
  // A Moebius strip.
  Soup strip;
  constexpr int kParts = 24;
  const auto corner = [&](int i, double side) {
    const double a = 2 * M_PI * i / kParts, half = a / 2;
    const double r = 1 + side * 0.2 * std::cos(half);
    return Vector3d(r * std::cos(a), r * std::sin(a), side * 0.2 * std::sin(half));
  };
  for (int i = 0; i < kParts; ++i) {
    const Vector3d a = corner(i, -1), b = corner(i, 1), c = corner(i + 1, -1), d = corner(i + 1, 1);
    strip.add(a, c, b), strip.add(b, c, d);
  }
  TriangleMesh mesh = soup_mesh(strip);
  const TriangleMesh before = mesh;
  CHECK_FALSE(turn_outwards(mesh).any());
  CHECK(same_mesh(mesh, before));
  // Two tetrahedra that share an edge: four triangles meet there.
  Soup two;
  const auto tetrahedron = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
    two.add(a, c, b), two.add(a, b, d), two.add(b, c, d), two.add(c, a, d);
  };
  tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  tetrahedron({0, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1});
  TriangleMesh right = soup_mesh(two), other = right;
  CHECK_FALSE(turn_outwards(right).any());
  turn_all(other);
  CHECK(turn_outwards(other).shells == 2);
  CHECK(other.indices == right.indices);
}
