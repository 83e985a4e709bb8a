#include "sim_node/contacts/friction_maps.h"

#include <catch2/catch.hpp>
#include <tactus/asset_ref_t.hpp>
#include <tactus/material_def_t.hpp>

#include "sim_node/world/simulation.h"
#include "sync/bus/identity.h"
#include "tests/grey_png.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

// A slope of 20 degrees with a box of 0.1 kg. The u axis of the slope's map points uphill. The halves have 0.25 and 4
// times a friction of 0.4.
constexpr double kSlope_rad = 20 * M_PI / 180, kFriction = 0.4;

WorldDef slope(double box_at_u_m) {
  WorldDef w = empty_world(9.81);
  const std::vector<std::uint8_t> picture = tactus::test::png_bytes(64, 2, 8, [] {
    std::vector<std::uint8_t> grey;
    for (int i = 0; i < 128; ++i) grey.push_back(i % 64 < 32 ? 0 : 255);
    return grey;
  }());
  w.images.push_back({asset_ref_t::IMAGE, "halves.png", picture});
  material_def_t m{};
  m.youngs_modulus_Pa = 1e10, m.poissons_ratio = 0.3, m.friction_static = m.friction_dynamic = kFriction;
  w.materials = {m, m};
  m.friction_asset = sync::fnv1a_64(picture.data(), picture.size());
  m.friction_size_u_m = m.friction_size_v_m = 2, m.friction_black = 0.25, m.friction_white = 4;
  w.materials[1] = m;
  const Eigen::Isometry3d tilted(Eigen::AngleAxisd(-kSlope_rad, Vector3d::UnitY()));  // x points uphill
  const int ground = add_body(w, "slope", 0, Eigen::Matrix3d::Identity(), tilted);
  add_shape(w, ground, ShapeKind::kBox, {4, 1, 0.1}, kFriction);
  w.shapes.back().material = 1;
  const double mass = 0.1, side = 0.1;
  const int box = add_body(w, "box", mass, Eigen::Matrix3d::Identity() * (mass * side * side / 6),
                           tilted * Eigen::Translation3d(box_at_u_m, 0, 0.05 + side / 2));
  add_shape(w, box, ShapeKind::kBox, {side, side, side}, kFriction);
  w.shapes.back().material = 0;
  return w;
}

// Downhill speed after one second, m/s.
double slid(const WorldDef& w, const std::string& solver) {
  Settings settings;
  settings.solver = solver;
  Simulation s(w, settings);
  s.start(1);
  for (int i = 0; i < 500; ++i) s.step({});
  const BodyMotion& box = s.bodies()[1];
  return -box.velocity_m_s.dot(Eigen::AngleAxisd(-kSlope_rad, Vector3d::UnitY()) * Vector3d::UnitX());
}

}  // namespace

TEST_CASE("A box slides on the slippery half of a slope and sticks on the rough half, with every contact law") {
  const std::string solver = GENERATE("impulse", "penalty", "quick");
  // Friction of the pair: sqrt(0.4 * 0.4) times the root of the factor, 0.2 and 0.8. tan 20 degrees is 0.36.
  const double g = 9.81, after_s = 0.5;
  const double sliding = g * (std::sin(kSlope_rad) - 0.2 * std::cos(kSlope_rad)) * after_s;
  CAPTURE(solver);
  CHECK(slid(slope(0.5), solver) == Approx(sliding).epsilon(0.05));
  CHECK(std::abs(slid(slope(1.5), solver)) < 0.02);
  SECTION("uniform friction with the same coefficients gives the same motion") {
    WorldDef plain = slope(0.5);
    plain.materials[1].friction_asset = 0;
    CHECK(std::abs(slid(plain, solver)) < 0.02);  // 0.4: it sticks
    plain.shapes[0].friction = kFriction * 0.25;
    CHECK(slid(plain, solver) == Approx(slid(slope(0.5), solver)).epsilon(0.02));
  }
}

TEST_CASE("Each of two mapped surfaces has a factor at its own position, in either order") {
  WorldDef w = slope(0.5);
  w.shapes[1].material = 1;
  const FrictionMaps maps(w);
  CHECK(maps.applies(0, 1));
  Manifold m;
  m.shape_a = 0, m.shape_b = 1, m.body_a = 0, m.body_b = 1, m.count = 1;
  m.points[0].point_m = Vector3d(0.5, 0, 0), m.points[0].normal = Vector3d::UnitZ();
  // At the box's position its own u is 1.5.
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  maps.apply(here, Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0)), m);
  CHECK(m.points[0].friction == Approx(std::sqrt(0.25 * 4)));
  maps.apply(here, here, m);
  CHECK(m.points[0].friction == Approx(0.25));
  w.materials[1].friction_asset = 0;
  CHECK_FALSE(FrictionMaps(w).applies(0, 1));
}
