// Height maps: the attributes of <tactus:material>, and their way to the renderers.
#include <map>
#include <string_view>
#include <tactus/asset_ref_t.hpp>
#include <tactus/material_def_t.hpp>
#include <tactus/scene_t.hpp>

#include "tests/sim_node/support/scene_file.h"
#include "sim_node/scene/scene_assets.h"
#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "tests/grey_png.h"

using namespace tactus;
using namespace tactus::sim;
using tactus::test::png_bytes;

namespace {
const std::string kGood = "bump='planks.png' bump_size='0.5m 20cm' bump_height='1mm'";

sync::Bytes ramp(std::uint8_t highest = 255) { return png_bytes(2, 2, 8, {0, 10, 20, highest}); }

// A world with these materials, and the picture in its folder.
SceneFile scene(const std::string& materials, const sync::Bytes& picture = ramp()) {
  return SceneFile(world(materials), {{"planks.png", picture}});
}
std::string material_error(const std::string& attributes, const sync::Bytes& picture = ramp()) {
  SceneFile file = scene("<tactus:material name='p' base='oak' " + attributes + "/>", picture);
  return file.load_error();
}
const material_def_t& material_of(const WorldDef& w, std::string_view name) {
  for (const auto& m : w.materials)
    if (m.name == name) return m;
  FAIL("no material " << name);
  return w.materials.front();
}
}  // namespace

TEST_CASE("A material refers to its height map by content hash, with size and height") {
  SceneFile file = scene("<tactus:material name='p' base='oak' " + kGood + "/><tactus:material name='q' base='p' density='900'/>");
  const WorldDef w = file.load();
  const material_def_t& p = material_of(w, "p");
  const sync::Bytes bytes = ramp();
  CHECK(p.bump_asset == sync::fnv1a_64(bytes.data(), bytes.size()));
  CHECK(p.bump_size_u_m == Approx(0.5));
  CHECK(p.bump_size_v_m == Approx(0.2));
  CHECK(p.bump_height_m == Approx(0.001));
  CHECK(material_of(w, "oak").bump_asset == 0);
  SECTION("a derived material inherits the height map") {
    const material_def_t& q = material_of(w, "q");
    CHECK(q.density_kg_m3 == 900);
    CHECK(q.bump_asset == p.bump_asset);
    CHECK(q.bump_size_u_m == p.bump_size_u_m);
    CHECK(q.bump_size_v_m == p.bump_size_v_m);
    CHECK(q.bump_height_m == p.bump_height_m);
  }
}

TEST_CASE("A height map is sent once, unchanged, for all materials that use it") {
  const sync::Bytes other = ramp(7);
  SceneFile file(world("<tactus:material name='p' base='oak' " + kGood + "/><tactus:material name='q' base='p'/>"
                       "<tactus:material name='r' base='oak' bump='copy.png' bump_size='1 1' bump_height='1mm'/>"
                       "<tactus:material name='s' base='oak' bump='other.png' bump_size='1 1' bump_height='1mm'/>"),
                 {{"planks.png", ramp()}, {"copy.png", ramp()}, {"other.png", other}});
  const auto assets = make_assets(file.load());
  const auto decoded = sync::decode_asset<scene_t>(assets[0].bytes);
  REQUIRE(decoded);
  std::map<std::int64_t, sync::Bytes> images;
  for (const sync::Asset& a : assets)
    if (a.kind == asset_ref_t::IMAGE) CHECK(images.emplace(sync::fnv1a_64(a.bytes.data(), a.bytes.size()), a.bytes).second);
  CHECK(images.size() == 2);
  int rough = 0;
  for (const material_def_t& m : decoded->materials) {
    if (m.bump_asset == 0) continue;
    ++rough;
    REQUIRE(images.contains(m.bump_asset));
    CHECK(images[m.bump_asset] == (m.name == "s" ? other : ramp()));
  }
  CHECK(rough == 4);
}

TEST_CASE("An invalid height map is rejected with its line") {
  SceneFile absent(world("\n<tactus:material name='p' base='oak' " + kGood + "/>"));
  CHECK_THAT(absent.load_error(), Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("\"planks.png\", which is not found"));
  const auto expect_rejection = [](const std::string& attributes, const std::string& because) {
    CHECK_THAT(material_error(attributes), Catch::StartsWith("scene.sdf:3: ") && Catch::Contains(because));
  };
  CHECK(material_error(kGood) == "");
  SECTION("picture, size and height are required together") {
    expect_rejection("bump='planks.png' bump_height='1mm'", "lacks its attribute \"bump_size\"");
    expect_rejection("bump='planks.png' bump_size='1m 1m'", "lacks its attribute \"bump_height\"");
    expect_rejection("bump_size='1m 1m'", "bump_size without bump");
    expect_rejection("bump_height='1mm'", "bump_height without bump");
    expect_rejection("bump='' bump_size='1m 1m' bump_height='1mm'", "lacks its attribute \"bump\"");
  }
  SECTION("sizes and heights out of range are rejected") {
    const auto sized = [](const std::string& size, const std::string& height) {
      return "bump='planks.png' bump_size='" + size + "' bump_height='" + height + "'";
    };
    expect_rejection(sized("0.5m", "1mm"), "2 quantities");
    expect_rejection(sized("1m 1m 1m", "1mm"), "2 quantities");
    expect_rejection(sized("1m 0m", "1mm"), "between 0.0001 and 100 m");
    expect_rejection(sized("-1m 1m", "1mm"), "between 0.0001 and 100 m");
    expect_rejection(sized("1000m 1m", "1mm"), "between 0.0001 and 100 m");
    expect_rejection(sized("1m nan", "1mm"), "bump_size");
    expect_rejection(sized("1kg 1m", "1mm"), "bump_size");
    expect_rejection(sized("1m 1m", "0"), "between 1e-07 and 0.1 m");
    expect_rejection(sized("1m 1m", "-1mm"), "between 1e-07 and 0.1 m");
    expect_rejection(sized("1m 1m", "2m"), "between 1e-07 and 0.1 m");
  }
  SECTION("a picture that is not a height map is rejected") {
    const auto unread = [](const sync::Bytes& picture, const std::string& because) {
      CHECK_THAT(material_error(kGood, picture), Catch::StartsWith("scene.sdf:3: ") && Catch::Contains("cannot be read: " + because));
    };
    unread({'h', 'e', 'l', 'l', 'o'}, "it is not a PNG file");
    unread(png_bytes(2, 2, 8, sync::Bytes(12), PNG_COLOR_TYPE_RGB), "it must be grey");
    unread(png_bytes(5000, 2, 8, sync::Bytes(10'000)), "it must have 2 to 4097 samples per side");
    sync::Bytes cut = png_bytes(100, 100, 8, sync::Bytes(10'000, 7));
    cut.resize(60);
    unread(cut, "it is truncated");
  }
}
