#include "sim_node/collision/detectors/chosen_detector.h"

#include <catch2/catch.hpp>

#include "sim_node/behaviour/solver.h"
#include "tests/sim_node/support/meshes.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

int add_mesh(WorldDef& w, const Soup& s) {
  TriangleMesh m{s.vertices, std::vector<Vector3d>(s.vertices.size(), Vector3d::UnitZ()), s.indices};
  w.meshes.push_back(m);
  return static_cast<int>(w.meshes.size()) - 1;
}

int add_mesh_body(WorldDef& w, int mesh, double mass, const Eigen::Matrix3d& inertia,
                  const Eigen::Isometry3d& pose) {
  const int body = add_body(w, "thing", mass, inertia, pose);
  const int s = add_shape(w, body, ShapeKind::kMesh, {1, 1, 1});
  w.shapes[static_cast<std::size_t>(s)].mesh = mesh;
  return body;
}

Settings with(const std::string& detector) {
  Settings s;
  s.solver = "quick";
  s.detector = detector;
  return s;
}

}  // namespace

TEST_CASE("With the layered detector a mesh box rests on a mesh table without overlap") {
  const int fineness = GENERATE(1, 6);
  const std::string mode = GENERATE("complete", "itouch2005");
  INFO(mode << ", fineness " << fineness);
  WorldDef w = empty_world();
  const int table = add_mesh(w, [&] {
    Soup s = plate(0.4, 0.4, fineness, fineness + 1);
    s.add(box({0.4, 0.4, 0.02}), at(0, 0, -0.0101));
    return s;
  }());
  const Vector3d size(0.1, 0.08, 0.06);
  const int cube = add_mesh(w, box(size));
  add_mesh_body(w, table, 0, Eigen::Matrix3d::Identity(), at(0, 0, 0));
  const int body = add_mesh_body(w, cube, 1, box_inertia(1, size), at(0.01, 0.02, 0.034));
  Settings settings = with("layers");
  settings.contact_mode = mode;
  Solver solver(w, settings);
  double lowest = 1;
  for (int i = 0; i < 1000; ++i) {
    solver.step();
    lowest = std::min(lowest, solver.bodies()[static_cast<std::size_t>(body)].position_m.z() - 0.03);
  }
  const BodyMotion& m = solver.bodies()[static_cast<std::size_t>(body)];
  CHECK(lowest > 0);
  CHECK(m.velocity_m_s.norm() < 1e-3);
  CHECK(m.spin_rad_s.norm() < 1e-2);
  // Within the tolerance, minus the part of the surface layer that a resting body may use.
  CHECK(m.position_m.z() - 0.03 > 0.5 * settings.contact_tolerance_m);
  CHECK(m.position_m.z() - 0.03 < settings.contact_tolerance_m);
  REQUIRE(solver.contacts().size() == 1);
  CHECK(solver.contacts()[0].count == 4);
  double force = 0;
  for (const ManifoldPoint& p : solver.solved()[0].used()) force += p.normal_force_N;
  CHECK(force == Approx(kG).margin(0.05));
}

TEST_CASE("ODE handles pairs that the selected detector does not support, and an unsupported shape is an error") {
  for (const std::string name : {"ode", "layers", "ccd", "ccd_mpr"}) {
    WorldDef w = empty_world();
    add_floor(w);
    const int ball = add_ball(w, 1, 0.05, {0, 0, 0.06});
    const int box_body = add_box(w, 1, {0.1, 0.1, 0.1}, at(0.5, 0, 0.06));
    Solver solver(w, with(name));
    for (int i = 0; i < 500; ++i) solver.step();
    INFO(name);
    CHECK(solver.bodies()[static_cast<std::size_t>(ball)].position_m.z() == Approx(0.05).margin(2e-3));
    CHECK(solver.bodies()[static_cast<std::size_t>(box_body)].position_m.z() == Approx(0.05).margin(2e-3));
  }
  WorldDef w = empty_world();
  add_mesh_body(w, add_mesh(w, comb(3, 0.1)), 1, Eigen::Matrix3d::Identity() * 1e-3, at(0, 0, 1));
  CHECK_THROWS_WITH(Solver(w, with("ccd")), Catch::Contains("convex meshes only"));
  CHECK_NOTHROW(Solver(w, with("layers")));

  // Options that the mesh does not support are rejected too: a plate is not a closed mesh.
  Settings adjacency = with("layers");
  adjacency.duplicate_remover = "adjacency";
  CHECK_NOTHROW(Solver(w, adjacency));
  add_mesh_body(w, add_mesh(w, plate(0.1, 0.1, 1, 1)), 0, Eigen::Matrix3d::Identity(), at(0, 0, 0));
  CHECK_THROWS_WITH(Solver(w, adjacency), Catch::Contains("choose the hashed remover"));
}
