#include <catch2/catch.hpp>

#include "sim_node/behaviour/solver.h"
#include "tests/sim_node/support/hard_scenes.h"
#include "tests/sim_node/support/penetration_oracle.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

Settings impulses_at(double h) {
  Settings s;
  s.solver = "impulse";
  s.detector = "auto";
  s.step_s = h;
  return s;
}

// Allowed penetration between bodies, m.
constexpr double kAllowed_m = 1e-5;

double deepest(const HardScene& scene, double h, double seconds) {
  Solver s(scene.world, impulses_at(h));
  PenetrationOracle oracle(scene.world);
  double worst = 0;
  for (int i = 0; i < seconds / h; ++i) {
    s.step();
    worst = std::max(worst, oracle.deepest(s.bodies()).depth_m);
  }
  for (std::size_t i = 0; i < scene.world.bodies.size(); ++i) {
    const Vector3d p = s.bodies()[i].centre_m;
    if (!scene.world.bodies[i].is_static && p.head<2>().cwiseAbs().maxCoeff() < 0.45) CHECK(p.z() > scene.floor_m);
  }
  return worst;
}

}  // namespace

TEST_CASE("The penetration oracle returns the depth of an overlap") {
  WorldDef w = empty_world();
  add_ball(w, 1, 0.1, {0, 0, 0.099});
  add_floor(w);
  add_box(w, 1, {0.2, 0.2, 0.2}, at(0.198, 0, 0.5));
  add_box(w, 1, {0.2, 0.2, 0.2}, at(0, 0, 0.5) * Eigen::AngleAxisd(0.1, Vector3d::UnitX()));
  const int lump = add_mesh(w, icosphere(3, 0.05));
  add_mesh_body(w, lump, 1, 0.05, at(2, 0, 1), 0);
  add_mesh_body(w, lump, 1, 0.05, at(2.0985, 0, 1), 0);
  const int can = add_body(w, "can", 1, ball_inertia(1, 0.1), at(4, 0, 1));
  add_shape(w, can, ShapeKind::kCylinder, {0.05, 0, 0.1});
  const int other = add_body(w, "can", 1, ball_inertia(1, 0.1), at(4.0993, 0, 1.02));
  add_shape(w, other, ShapeKind::kCylinder, {0.05, 0, 0.1});
  std::vector<BodyMotion> bodies(w.bodies.size());
  const auto only = [&](std::initializer_list<int> there) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const bool is = std::find(there.begin(), there.end(), static_cast<int>(i)) != there.end();
      bodies[i].position_m = w.bodies[i].pose.translation() +
                             Vector3d(0, 0, is || w.bodies[i].is_static ? 0 : 100.0 * static_cast<double>(i + 1));
      bodies[i].orientation = Eigen::Quaterniond(w.bodies[i].pose.linear());
    }
    return PenetrationOracle(w).deepest(bodies).depth_m;
  };
  CHECK(only({0, 1}) == Approx(0.001).epsilon(1e-6));
  CHECK(only({2, 3}) == Approx(0.002).epsilon(1e-6));
  // A corner of each ball is on the line between them, where they overlap by 1.5 mm.
  CHECK(only({4, 5}) == Approx(0.0015).epsilon(0.1));
  CHECK(only({6, 7}) == Approx(0.0007).epsilon(1e-3));
  CHECK(only({}) == 0);
}

TEST_CASE("Bodies at 20 m/s do not penetrate a wall of 1 mm, at 1 kHz and 60 Hz") {
  const double h = GENERATE(0.001, 1.0 / 60), e = GENERATE(0.0, 0.5);
  const bool boxes = GENERATE(false, true);
  INFO("step " << h << " restitution " << e << (boxes ? " boxes" : " balls"));
  CHECK(deepest(shot_at_wall(e, boxes), h, 0.1) <= kAllowed_m);
}

TEST_CASE("Spinning rods, a heap, a row of balls and a chain do not penetrate") {
  const double h = GENERATE(0.001, 1.0 / 60);
  INFO("step " << h);
  CHECK(deepest(rods(), h, 0.15) <= kAllowed_m);
  CHECK(deepest(heap(15), h, 0.5) <= kAllowed_m);
  CHECK(deepest(cradle(0), h, 0.1) <= kAllowed_m);
  CHECK(deepest(chain_and_post(), h, 0.6) <= kAllowed_m);
}

TEST_CASE("Irregular meshes that fall on each other do not penetrate") {
  CHECK(deepest(lumps(5), 0.001, 0.08) <= kAllowed_m);
}

TEST_CASE("A step is subdivided only if rotation would pass through a thin wall") {
  WorldDef w = thin_wall(0);
  const int box = add_box(w, 0.2, {0.3, 0.02, 0.02}, at(0, 0, 0.03));
  Solver still(w, impulses_at(0.001));
  still.step();
  CHECK(still.report()->substeps == 1);
  Solver turning(w, impulses_at(0.001));
  turning.set_spin(box, {0, 150, 0});
  for (int i = 0; i < 50; ++i) {
    turning.step();
    CHECK(turning.report()->max_overlap_m <= kAllowed_m);
    if (i == 0) CHECK(turning.report()->substeps > 1);
  }
  CHECK(turning.bodies()[static_cast<std::size_t>(box)].centre_m.z() > 0);
}

TEST_CASE("A body that an impact accelerates towards a distant wall stops there") {
  WorldDef w = empty_world(0);
  add_box(w, 0, {0.001, 1, 1}, at(0.035, 0, 0), 0.5, 0);
  const int struck = add_ball(w, 0.01, 0.01, {0, 0, 0}, 0, 1);
  const int striker = add_ball(w, 1, 0.01, {-0.0215, 0, 0}, 0, 1);
  body_of(w, striker).velocity_m_s = {15, 0, 0};
  Solver s(w, impulses_at(0.001));
  for (int i = 0; i < 20; ++i) {
    s.step();
    CHECK(s.bodies()[static_cast<std::size_t>(struck)].centre_m.x() < 0.0245 + kAllowed_m);
  }
}
