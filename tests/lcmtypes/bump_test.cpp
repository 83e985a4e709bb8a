// Tests of the projection of a surface point into a map, and of the validation of a relief.
#include "lcmtypes/bump.h"

#include <catch2/catch.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>

#include "tests/lcmtypes/samples.h"

using namespace tactus;
using Eigen::Vector2d;
using Eigen::Vector3d;

TEST_CASE("The dominant axis of the normal selects the projection cyclically") {
  const auto axes = [](const Vector3d& normal) {
    const BumpAxes a = bump_axes(normal);
    return std::array{a.across, a.u, a.v};
  };
  CHECK(axes({0.1, -0.2, 0.9}) == std::array{2, 0, 1});
  CHECK(axes({0.9, 0.1, -0.2}) == std::array{0, 1, 2});
  CHECK(axes({0.1, 0.9, -0.2}) == std::array{1, 2, 0});
  SECTION("the sign of the normal has no effect") {
    CHECK(axes({0, 0, -1}) == axes({0, 0, 1}));
    CHECK(axes({-1, 0, 0}) == axes({1, 0, 0}));
    CHECK(axes({0, -1, 0}) == axes({0, 1, 0}));
  }
  SECTION("ties prefer z over x over y") {
    CHECK(axes({1, 1, 1}) == axes({0, 0, 1}));
    CHECK(axes({1, 1, 0}) == axes({1, 0, 0}));
  }
}

TEST_CASE("Map coordinates are counted in repetitions of the map") {
  const Eigen::Vector2f size_m(0.5, 0.25);
  const Vector3d point(1, 2, 3);
  CHECK(bump_at(size_m, bump_axes({0, 0, 1}), point) == Vector2d(2, 8));   // x, y
  CHECK(bump_at(size_m, bump_axes({1, 0, 0}), point) == Vector2d(4, 12));  // y, z
  CHECK(bump_at(size_m, bump_axes({0, -1, 0}), point) == Vector2d(6, 4));  // z, x
}

TEST_CASE("A relief out of range is rejected, and without a map any finite numbers are valid") {
  test::Samples samples(1);
  scene_t scene{};
  samples.fill(scene);
  scene.materials.resize(1), scene.material_count = 1;
  samples.fill(scene.materials[0]);
  material_def_t& m = scene.materials[0];
  m.bump_asset = 7, m.bump_size_u_m = m.bump_size_v_m = 0.5, m.bump_height_m = 0.001;
  REQUIRE(valid(scene));
  for (double material_def_t::*field :
       {&material_def_t::bump_size_u_m, &material_def_t::bump_size_v_m, &material_def_t::bump_height_m})
    for (const double wrong : {0.0, -0.5, 1e-9, 1e3}) {
      const double right = m.*field;
      m.*field = wrong;
      CHECK_FALSE(valid(scene));
      m.*field = right;
    }
  m.bump_asset = 0, m.bump_height_m = 0;
  CHECK(valid(scene));
}
