#include "sim_node/behaviour/behaviour_checks.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim_node/world/simulation.h"
#include "sim_node/behaviour/solver.h"
#include "sim_node/collision/detector.h"
#include "tests/sim_node/support/detectors.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Catch::Contains;

namespace {

constexpr double kRadius_m = 0.02, kMass_kg = 0.1;

// A ball of triangles, for which the detector "layers" reports gaps, over a box as floor.
WorldDef ball_over_box(double gap_m) {
  WorldDef w = empty_world();
  const int floor = add_body(w, "floor", 0, Eigen::Matrix3d::Identity(), at(0, 0, -0.05));
  add_shape(w, floor, ShapeKind::kBox, {1, 1, 0.1});
  const int ball = add_body(w, "ball", kMass_kg, ball_inertia(kMass_kg, kRadius_m), at(0, 0, kRadius_m + gap_m));
  add_shape(w, ball, ShapeKind::kMesh, {1, 1, 1});
  TriangleMesh octahedron;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0})
      octahedron.vertices.push_back(side * kRadius_m * Eigen::Vector3d::Unit(axis));
  for (const int x : {0, 1})
    for (const int y : {2, 3})
      for (const int z : {4, 5}) {
        const bool flipped = (x + y + z) % 2 != 0;
        octahedron.indices.insert(octahedron.indices.end(), {x, flipped ? z : y, flipped ? y : z});
      }
  octahedron.normals.resize(octahedron.vertices.size(), Eigen::Vector3d::UnitZ());
  w.meshes.push_back(octahedron);
  w.shapes.back().mesh = 0;
  return w;
}

Settings settings(const std::string& solver, const std::string& detector) {
  Settings s;
  s.solver = solver;
  s.detector = detector;
  return s;
}

}  // namespace

TEST_CASE("The setting accepts every model and rejects other names") {
  for (const std::string_view name : kSolvers) CHECK(behaviour_model(name).name == name);
  CHECK_THROWS_WITH(behaviour_model("jelly"), Contains("jelly") && Contains("choose quick, step"));
}

TEST_CASE("Impulse and penalty models reject only detectors that report overlap") {
  for (const std::string_view name : kDetectors) {
    const DetectorAbilities abilities = make_detector(name)->abilities();
    for (const std::string_view solver : kSolvers) {
      const BehaviourModel& m = behaviour_model(solver);
      INFO(name << " " << m.name);
      const std::string why = unsupported_reason(m, abilities);
      CHECK(why.empty() == (abilities.separation || m.name == "quick" || m.name == "step"));
      if (!why.empty())
        CHECK_THAT(why, Contains(std::string(name)) && Contains("choose a detector that reports gaps"));
    }
  }
  for (const std::string solver : {"impulse", "penalty", "penalty_explicit"})
    for (const std::string detector : {"ode", "ccd_mpr"})
      CHECK_THROWS_WITH(Solver(ball_over_box(0.01), settings(solver, detector)), Contains("does not report"));
}

TEST_CASE("Two groups reject the same combinations as one group") {
  Settings s = settings("impulse", GENERATE("ode", "ccd_mpr"));
  s.groups = "dual";
  s.visual_thread = "none";
  CHECK_THROWS_WITH(Simulation(ball_over_box(0.01), s), Contains(s.detector) && Contains("does not report"));
  s.solver = GENERATE("quick", "step", "penalty");
  CHECK_THROWS_WITH(Simulation(ball_over_box(0.01), s), Contains(s.solver) && Contains("groups = single"));
  s = settings("impulse", "gaps");
  s.groups = "dual";
  s.visual_thread = "none";
  CHECK_NOTHROW(Simulation(ball_over_box(0.01), s));
}

TEST_CASE("Explicit penalty that is unstable for step and mass is rejected with the stable limit") {
  // A mesh presses with up to four points: 4 m / (4 h^2) minus the damper's 2 d / h.
  Settings s = settings("penalty_explicit", "layers");
  const double most = kMass_kg / 1e-6 - 2 * s.penalty_damping_Ns_m / 1e-3;
  s.penalty_stiffness_N_m = 0.99 * most;
  CHECK(unsupported_reason(ball_over_box(0.01), s).empty());
  s.penalty_stiffness_N_m = 1.01 * most;
  CHECK_THAT(unsupported_reason(ball_over_box(0.01), s),
             Contains("\"ball\"") && Contains("9e+04 N/m") && Contains("choose \"penalty\""));
  CHECK_THROWS(Solver(ball_over_box(0.01), s));
  // A sphere with one point allows four times the stiffness; a static body allows any.
  WorldDef w = empty_world();
  add_ball(w, kMass_kg, kRadius_m, {0, 0, 1});
  add_floor(w);
  s.penalty_stiffness_N_m = 3 * most;
  CHECK(unsupported_reason(w, s).empty());
  // The implicit form is stable with any stiffness.
  s.solver = "penalty";
  s.penalty_stiffness_N_m = 1e9;
  CHECK(unsupported_reason(ball_over_box(0.01), s).empty());
}

TEST_CASE("Every model that needs trees rejects a loop of joints by name") {
  WorldDef w = chain_world(3);
  add_joint(w, JointKind::kBall, -1, 2, {0, 0, 1.7}, {1, 0, 0});
  for (const std::string_view solver : kSolvers) {
    const BehaviourModel& m = behaviour_model(solver);
    const Settings s = settings(std::string(m.name), "layers");
    INFO(m.name);
    if (m.needs_trees)
      CHECK_THROWS_WITH(Solver(w, s), Contains("closes a loop") && Contains("\"" + s.solver + "\""));
    else
      CHECK_NOTHROW(Solver(w, s));
  }
}

TEST_CASE("A body of a scene rests in the penalty shell without an impact on arrival") {
  const std::string solver = GENERATE("penalty", "penalty_explicit");
  const Settings s = settings(solver, "layers");
  Solver sim(ball_over_box(0.001), s);
  double most = 0, last = 0;
  for (int i = 0; i < 4000; ++i) {
    sim.step();
    last = 0;
    for (const Manifold& m : sim.solved())
      for (const ManifoldPoint& p : m.used()) last += p.normal_force_N;
    most = std::max(most, last);
  }
  CHECK(last == Approx(kMass_kg * kG).epsilon(1e-3));
  // After the fall of 0.5 mm to the shell, energy gives at most mg (1 + sqrt(1 + 2 k height / mg)), plus at most d v
  // by the damper. A hard contact would give m v / h = 10 N.
  const double weight = kMass_kg * kG, height = 0.0005, k = s.penalty_stiffness_N_m;
  CHECK(most < weight * (1 + std::sqrt(1 + 2 * k * height / weight)) +
                   s.penalty_damping_Ns_m * std::sqrt(2 * kG * height));
  const double gap = sim.bodies()[1].position_m.z() - kRadius_m;
  CHECK(s.contact_tolerance_m - gap == Approx(weight / k).epsilon(1e-3));
}
