// Tests of heights and slopes of a surface relief.
#include "lcmtypes/relief.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <tactus/material_def_t.hpp>

using namespace tactus;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

material_def_t rough(double size_u_m, double size_v_m, double height_m) {
  material_def_t m{};
  m.bump_asset = 1, m.bump_size_u_m = size_u_m, m.bump_size_v_m = size_v_m, m.bump_height_m = height_m;
  return m;
}

HeightMap noise(int columns, int rows, unsigned seed) {
  std::mt19937 random(seed);
  HeightMap map;
  map.columns = columns, map.rows = rows, map.white = 65535;
  for (int i = 0; i < columns * rows; ++i) map.levels.push_back(static_cast<std::uint16_t>(random() % 65536));
  return map;
}

// The same heights in every row.
HeightMap ridges(int columns, int rows, unsigned seed) {
  const HeightMap one = noise(columns, 1, seed);
  HeightMap map{columns, rows, 65535, {}};
  for (int r = 0; r < rows; ++r) map.levels.insert(map.levels.end(), one.levels.begin(), one.levels.end());
  return map;
}

HeightMap waves(int columns, int rows) {
  HeightMap map{columns, rows, 65535, {}};
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double u = (c + 0.5) / columns, v = (r + 0.5) / rows;
      const double h =
          0.5 + 0.3 * std::sin(2 * std::numbers::pi * (u + 2 * v)) + 0.2 * std::cos(2 * std::numbers::pi * u);
      map.levels.push_back(static_cast<std::uint16_t>(std::lround(65535 * h)));
    }
  return map;
}

}  // namespace

TEST_CASE("The slope of a sine map is its derivative, and the image points up along v") {
  const HeightMap map = waves(64, 128);
  const Relief relief = make_relief(map, rough(0.4, 0.2, 0.002));
  const double w = 2 * std::numbers::pi;
  for (double u = 0.013; u < 1; u += 0.051)
    for (double v = 0.007; v < 1; v += 0.043) {
      const double du = 0.002 / 0.4 * w * (0.3 * std::cos(w * (u + 2 * v)) - 0.2 * std::sin(w * u));
      const double dv = 0.002 / 0.2 * w * 2 * 0.3 * std::cos(w * (u + 2 * v));
      // Central differences over a step of s radians lose s^2 / 6 of each wave, linear interpolation another s^2 / 8; s = 2 pi / 64 in
      // both directions.
      const double lost = std::pow(w / 64, 2) * (1 / 6. + 2 / 8.);
      const Vector2d s = relief.slope({u, v});
      CHECK(std::abs(s.x() - du) < lost * 0.002 / 0.4 * w * 0.5 + 2e-5);
      CHECK(std::abs(s.y() - dv) < lost * 0.002 / 0.2 * w * 0.6 + 4e-5);
      const double h = 0.002 * (0.5 + 0.3 * std::sin(w * (u + 2 * v)) + 0.2 * std::cos(w * u));
      CHECK(std::abs(relief.height_m({u, v}) - h) < 0.002 * 0.5 * std::pow(w / 64, 2) * 2 * 0.5);
    }
}

TEST_CASE("A relief is periodic, with continuous height and slope") {
  const Relief relief = make_relief(noise(16, 12, 3), rough(0.02, 0.03, 0.001));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-3, 3);
  for (int i = 0; i < 2000; ++i) {
    const Vector2d at(anywhere(random), anywhere(random)), far = at + Vector2d(5, -4);
    CHECK(relief.height_m(at) == Approx(relief.height_m(far)).margin(1e-12));
    CHECK((relief.slope(at) - relief.slope(far)).norm() < 1e-9);
    // Also across pixel edges: a step of 1e-7 of the map changes little, in any direction.
    const Vector2d near = at + 1e-7 * Vector2d(anywhere(random), anywhere(random));
    CHECK(std::abs(relief.height_m(at) - relief.height_m(near)) < 1e-8);
    CHECK((relief.slope(at) - relief.slope(near)).norm() < 1e-4);
  }
}

TEST_CASE("The slope of a ridge map is the derivative of its height along u and v") {
  const HeightMap along_u = ridges(24, 5, 11);
  HeightMap along_v{5, 24, 65535, {}};
  for (int r = 0; r < 24; ++r)
    for (int c = 0; c < 5; ++c) along_v.levels.push_back(along_u.levels[static_cast<std::size_t>(r)]);
  const Relief u = make_relief(along_u, rough(0.024, 1, 0.001)), v = make_relief(along_v, rough(1, 0.024, 0.001));
  constexpr double kStep = 1e-6;  // step in parts of the map; the height is of second order between its samples
  for (double at = 0.00013; at < 1; at += 0.0071) {
    const double rise = (u.height_m({at + kStep, 0.3}) - u.height_m({at - kStep, 0.3})) / (2 * kStep * 0.024);
    CHECK(u.slope({at, 0.3}).x() == Approx(rise).epsilon(1e-4).margin(1e-4));
    CHECK(std::abs(u.slope({at, 0.3}).y()) < 1e-12);
    CHECK(v.slope({0.3, at}).y() == Approx(u.slope({at, 0.3}).x()));
    CHECK(v.height_m({0.3, at}) == Approx(u.height_m({at, 0.3})));
  }
}

TEST_CASE("The normal of a relief tilts away from the rising side") {
  CHECK(relief_normal({0, 0, 1}, {0, 0}) == Vector3d(0, 0, 1));
  CHECK((relief_normal({0, 0, 1}, {1, 0}) - Vector3d(-1, 0, 1).normalized()).norm() < 1e-12);
  CHECK((relief_normal({0, 0, -1}, {1, 0}) - Vector3d(-1, 0, -1).normalized()).norm() < 1e-12);
  CHECK((relief_normal({0, 1, 0}, {0.5, 0.25}) - Vector3d(-0.25, 1, -0.5).normalized()).norm() < 1e-12);
  SECTION("the tilt equals the slope, also on an oblique surface") {
    const Vector3d n = Vector3d(0.3, -0.2, 0.8).normalized();
    const Vector3d m = relief_normal(n, {0.4, -0.7});
    Vector3d along(0.4, -0.7, 0);
    along -= along.dot(n) * n;
    CHECK(m.norm() == Approx(1));
    CHECK(std::acos(m.dot(n)) == Approx(std::atan(along.norm())));
    CHECK(m.dot(along) < 0);
  }
}
