// The attributes of <tactus:material> that give a material a friction map.
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>

#include "tests/sim_node/support/scene_file.h"
#include "sim_node/scene/scene_assets.h"
#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "tests/grey_png.h"

using namespace tactus;
using namespace tactus::sim;

namespace {

const std::string kGoodMap = "friction_map='halves.png' friction_size='0.5m 20cm' friction_factors='0.2 1.5'";

sync::Bytes halves() { return tactus::test::png_bytes(2, 2, 8, {0, 255, 0, 255}); }

SceneFile map_scene(const std::string& attributes, const sync::Bytes& picture = halves()) {
  return SceneFile(
      world("<tactus:material name='p' base='oak' " + attributes + "/><tactus:material name='q' base='p'/>"),
      {{"halves.png", picture}});
}

}  // namespace

TEST_CASE("A material refers to its friction map by content hash, with size and factors") {
  SceneFile file = map_scene(kGoodMap);
  const WorldDef w = file.load();
  const auto decoded = sync::decode_asset<scene_t>(make_assets(w)[0].bytes);
  REQUIRE(decoded);
  const sync::Bytes bytes = halves();
  REQUIRE(w.images.size() == 1);
  CHECK(w.images[0].bytes == bytes);
  int mapped = 0;
  for (const material_def_t& m : decoded->materials) {
    if (m.name != "p" && m.name != "q") {
      CHECK(m.friction_asset == 0);
      continue;
    }
    ++mapped;
    CHECK(m.friction_asset == sync::fnv1a_64(bytes.data(), bytes.size()));
    CHECK(m.friction_size_u_m == Approx(0.5));
    CHECK(m.friction_size_v_m == Approx(0.2));
    CHECK(m.friction_black == Approx(0.2));
    CHECK(m.friction_white == Approx(1.5));
    CHECK(m.bump_asset == 0);
  }
  CHECK(mapped == 2);  // one inherits it
}

TEST_CASE("An invalid friction map is rejected with its line") {
  const auto expect_rejection = [](const std::string& attributes, const std::string& because,
                          const sync::Bytes& picture = halves()) {
    SceneFile file = map_scene(attributes, picture);
    CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:3: ") && Catch::Contains(because));
  };
  SceneFile good = map_scene(kGoodMap);
  CHECK(good.load_error() == "");
  expect_rejection("friction_map='halves.png' friction_factors='0 1'", "lacks its attribute \"friction_size\"");
  expect_rejection("friction_map='halves.png' friction_size='1m 1m'", "lacks its attribute \"friction_factors\"");
  expect_rejection("friction_size='1m 1m'", "friction_size without friction_map");
  expect_rejection("friction_factors='1 1'", "friction_factors without friction_map");
  const auto with = [](const std::string& size, const std::string& factors) {
    return "friction_map='halves.png' friction_size='" + size + "' friction_factors='" + factors + "'";
  };
  expect_rejection(with("1m 0m", "0 1"), "between 0.0001 and 100 m");
  expect_rejection(with("1m 1m", "1"), "2 quantities");
  expect_rejection(with("1m 1m", "-0.1 1"), "between 0 and 20");
  expect_rejection(with("1m 1m", "0 21"), "between 0 and 20");
  expect_rejection(with("1m 1m", "0 nan"), "friction_factors");
  expect_rejection(kGoodMap, "names friction_map \"halves.png\", which cannot be read: it is not a PNG file", {'x'});
}
