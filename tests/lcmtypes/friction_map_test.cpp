// Tests of friction maps: factors, axes and interpolation.
#include "lcmtypes/friction_map.h"

#include <catch2/catch.hpp>
#include <tactus/material_def_t.hpp>

using namespace tactus;
using Eigen::Vector3d;

namespace {

// Two by two pixels: black, white in the lower row; white, black in the upper one.
FrictionMap checkered(double size_u_m, double size_v_m, double black, double white) {
  material_def_t m{};
  m.friction_asset = 1, m.friction_size_u_m = size_u_m, m.friction_size_v_m = size_v_m;
  m.friction_black = black, m.friction_white = white;
  return {HeightMap{2, 2, 255, {0, 255, 255, 0}}, m};
}

}  // namespace

TEST_CASE("Friction follows the grey value, bilinear between pixel centres") {
  const FrictionMap map = checkered(0.4, 0.2, 0.5, 1.5);
  const Vector3d up(0, 0, 1);
  CHECK(map.factor(up, {0.1, 0.05, 0}) == Approx(0.5));  // the centre of the lower left pixel
  CHECK(map.factor(up, {0.3, 0.05, 7}) == Approx(1.5));
  CHECK(map.factor(up, {0.1, 0.15, 0}) == Approx(1.5));
  CHECK(map.factor(up, {0.2, 0.05, 0}) == Approx(1.0));
  CHECK(map.factor(up, {0.15, 0.05, 0}) == Approx(0.75));
  CHECK(map.factor(up, {0.2, 0.1, 0}) == Approx(1.0));
  SECTION("the map repeats in all directions") {
    CHECK(map.factor(up, {0.1 + 0.8, 0.05 - 0.6, 0}) == Approx(0.5));
    CHECK(map.factor(up, {0.0, 0.05, 0}) == Approx(1.0));
  }
  SECTION("the map is projected on each side of a body like a relief") {
    CHECK(map.factor({1, 0, 0}, {9, 0.3, 0.05}) == Approx(1.5));     // y, z
    CHECK(map.factor({0, -1, 0}, {0.05, 9, 0.15}) == Approx(0.75));  // z, x: a quarter of the way along u
  }
}

TEST_CASE("The factor of one surface enters the pair with its square root, as in the geometric mean") {
  const double tool = 0.8, surface = 0.3, factor = 0.2;
  CHECK(std::sqrt(tool * surface) * pair_factor(factor) == Approx(std::sqrt(tool * (surface * factor))));
}
