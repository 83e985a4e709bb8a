#include "audio_node/excitation/audio_surfaces.h"

#include <catch2/catch.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>

#include "tests/audio_node/support/waves.h"
#include "tests/grey_png.h"

using namespace tactus;
using namespace tactus::audio;

TEST_CASE("Surfaces are read from the pictures of the scene, and an unreadable picture gives a smooth surface") {
  scene_t scene{};
  const sync::Bytes good = tactus::test::png_bytes(2, 2, 8, {0, 10, 20, 255}), bad{'x'};
  constexpr std::int64_t kGood = 1, kBad = 2, kNotSent = 3;
  for (const auto& [bump, friction] :
       {std::pair<std::int64_t, std::int64_t>{kGood, 0}, {0, kGood}, {kGood, kBad}, {kNotSent, 0}}) {
    material_def_t m = audio::test::rough();
    m.bump_asset = bump;
    m.friction_asset = friction, m.friction_size_u_m = m.friction_size_v_m = 0.1, m.friction_white = 1;
    scene.materials.push_back(m);
  }
  const auto surfaces = load_surfaces(scene, {{kGood, good}, {kBad, bad}});
  REQUIRE(surfaces->by_material.size() == 4);
  REQUIRE(surfaces->of(0));
  CHECK(surfaces->of(0)->relief);
  CHECK_FALSE(surfaces->of(0)->friction);
  REQUIRE(surfaces->of(1));
  CHECK_FALSE(surfaces->of(1)->relief);
  CHECK(surfaces->of(1)->friction);
  REQUIRE(surfaces->of(2));
  CHECK(surfaces->of(2)->relief == surfaces->of(0)->relief);  // shared
  CHECK_FALSE(surfaces->of(2)->friction);
  for (const int material : {-1, 3, 4}) CHECK_FALSE(surfaces->of(material));
  CHECK_FALSE(load_surfaces(scene, {})->of(0));
}
