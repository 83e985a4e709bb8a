#include "visual_node/scene_view/relief.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>

#include "tests/visual_node/support/test_scene.h"
#include "tests/grey_png.h"

using namespace tactus;
using namespace tactus::visual;

TEST_CASE("The slope of a drawn sine relief is its derivative") {
  const HeightMap map = test::sine_map(64, 16);
  const material_def_t material = test::rough(1, 0.4, 0.1, 0.002);
  const Relief relief = make_relief(map, material);
  REQUIRE(relief.columns == 64);
  REQUIRE(relief.rows == 16);
  CHECK(relief.size_m == Eigen::Vector2f(0.4f, 0.1f));
  // h = H/2 sin(2 pi u / L): at most pi H / L. Central differences over w = 2 pi / 64 lose w^2/6; 16 bits err by
  // half a level at each of the two neighbours, H / 65535 over two pixels of L / 64.
  const double steepest = std::numbers::pi * 0.002 / 0.4, w = 2 * std::numbers::pi / 64;
  const double tolerance = steepest * w * w / 6 + 0.002 / 65535 / (2 * 0.4 / 64);
  for (int row = 0; row < 16; ++row)
    for (int column = 0; column < 64; ++column) {
      const Eigen::Vector2f& slope = relief.slopes[static_cast<std::size_t>(row * 64 + column)];
      CHECK(std::abs(slope.x() - steepest * std::cos(w * (column + 0.5))) < tolerance);
      CHECK(slope.y() == 0);
    }
}

TEST_CASE("The height map points up along v") {
  HeightMap map;
  map.columns = map.rows = 4, map.white = 255;
  map.levels = {0, 0, 0, 0, 51, 51, 51, 51, 102, 102, 102, 102, 153, 153, 153, 153};
  const Relief relief = make_relief(map, test::rough(1, 0.4, 0.4, 0.01));
  CHECK(relief.slopes[4].y() == Approx(0.02));  // 1/5 of 10 mm in 0.1 m
  CHECK(relief.slopes[4].x() == 0);
  SECTION("the lowest row is next to the highest") {
    CHECK(relief.slopes[0].y() == Approx((51 - 153) / 255.0 * 0.01 / 0.2));
  }
}

TEST_CASE("A damaged or missing height map is reported once and does not affect others") {
  scene_t scene = test::empty_scene();
  const std::vector<std::uint8_t> good = test::png_bytes(2, 2, 8, {0, 10, 20, 255}), bad{'x'};
  for (const std::int64_t asset : {1, 2, 2, 12345, 0}) scene.materials.push_back(test::rough(asset, 1, 1, 0.001));
  std::vector<std::string> warnings;
  sync::ConfinedPictures reader;
  const HeightMaps maps = height_maps_of(scene, {{1, good}, {2, bad}}, reader, warnings);
  CHECK(maps.size() == 1);
  CHECK(maps.contains(1));
  REQUIRE(warnings.size() == 2);
  CHECK_THAT(warnings[0], Catch::Contains("it is not a PNG file; it is drawn smooth"));
  CHECK_THAT(warnings[1], Catch::Contains("it was not sent"));
}
