#include "thermal_node/skin/thickness.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>

using namespace tactus;

namespace {
shape_def_t shape(int body, std::int8_t kind, double x, double y = 0, double z = 0) {
  shape_def_t s{};
  s.body = body;
  s.kind = kind;
  s.size_m.x = x, s.size_m.y = y, s.size_m.z = z;
  return s;
}
}  // namespace

TEST_CASE("A body is as thick as the thickest of its shapes") {
  scene_t scene{};
  scene.bodies.resize(6);
  scene.shapes = {shape(0, shape_def_t::BOX, 0.3, 0.02, 0.4),     shape(1, shape_def_t::SPHERE, 0.03),
                  shape(2, shape_def_t::CYLINDER, 0.05, 0, 0.01), shape(3, shape_def_t::CAPSULE, 0.01, 0, 0.5),
                  shape(3, shape_def_t::BOX, 0.03, 0.03, 0.04),   shape(4, shape_def_t::PLANE, 10, 10),
                  shape(-1, shape_def_t::BOX, 1, 1, 1),           shape(99, shape_def_t::BOX, 1, 1, 1)};
  const auto thickness = thermal::thickness_of_bodies(scene);
  REQUIRE(thickness.size() == 6);
  CHECK(thickness[0] == 0.02);
  CHECK(thickness[1] == 0.06);
  CHECK(thickness[2] == 0.01);
  CHECK(thickness[3] == 0.03);
  CHECK(std::isinf(thickness[4]));
  CHECK(std::isinf(thickness[5]));
}
