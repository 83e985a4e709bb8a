// Tests of the validation of measured modes in a scene.
#include "lcmtypes/measured_modes.h"

#include <catch2/catch.hpp>
#include <limits>
#include <tactus/material_def_t.hpp>
#include <tactus/measured_mode_t.hpp>
#include <tactus/scene_t.hpp>

#include "lcmtypes/valid.h"
#include "tests/lcmtypes/samples.h"

using namespace tactus;

TEST_CASE("A scene with invalid measured modes is rejected") {
  test::Samples samples(1);
  scene_t scene{};
  samples.fill(scene);
  scene.materials.resize(1), scene.material_count = 1;
  samples.fill(scene.materials[0]);
  material_def_t& m = scene.materials[0];
  const measured_mode_t right{440, 3, 0.5};
  m.modes = {right}, m.mode_count = 1;
  REQUIRE(valid(scene));
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const measured_mode_t& wrong : {measured_mode_t{10, 3, 0.5},
                                       {20'001, 3, 0.5},
                                       {nan, 3, 0.5},
                                       {440, 0, 0.5},
                                       {440, -1, 0.5},
                                       {440, 2765, 0.5},
                                       {440, inf, 0.5},
                                       {440, 3, 0},
                                       {440, 3, inf}}) {
    m.modes = {wrong};
    CHECK_FALSE(valid(scene));
  }
  m.modes.assign(kMaxMeasuredModes + 1, right), m.mode_count = kMaxMeasuredModes + 1;
  CHECK_FALSE(valid(scene));
}
