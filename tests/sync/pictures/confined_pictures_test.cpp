#include "sync/pictures/confined_pictures.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <stdexcept>
#include <string>

#include "sync/pictures/picture_decoders.h"
#include "sync/pictures/picture_packing.h"
#include "tests/grey_png.h"
#include "tests/source_dir.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

using Bytes = std::vector<std::uint8_t>;

// The picture that a decoder makes of the bytes, or its clause.
template <class Decode>
Bytes outcome(Decode&& decode) {
  try {
    return pack(decode());
  } catch (const std::runtime_error& e) {
    const std::string what = text_of({'E', Bytes(e.what(), e.what() + std::string(e.what()).size())});
    return {what.begin(), what.end()};
  }
}

std::map<std::string, Bytes> pictures() {
  std::map<std::string, Bytes> all;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() + "/tests/fuzz/seeds/pictures")) {
    std::ifstream file(entry.path(), std::ios::binary);
    all[entry.path().filename().string()] = Bytes{std::istreambuf_iterator<char>(file), {}};
  }
  all["grey"] = test::png_bytes(3, 2, 8, {255, 0, 0, 0, 0, 51});
  return all;
}

}  // namespace

TEST_CASE("Confined decoders return the same bits and clauses as decoders in this process, also for damaged pictures") {
  std::mt19937 random(11);
  ConfinedPictures confined;
  std::size_t decoded = 0;
  for (const auto& [name, whole] : pictures()) {
    CAPTURE(name);
    for (int i = 0; i < 40; ++i) {
      Bytes bytes = whole;
      for (int k = 0; k < i % 4; ++k) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
      if (i % 7 == 6) bytes.resize(random() % bytes.size());
      REQUIRE(outcome([&] { return confined.raster(bytes); }) == outcome([&] { return read_raster(bytes); }));
      REQUIRE(outcome([&] { return confined.height_map(bytes); }) == outcome([&] { return read_height_map(bytes); }));
      ++decoded;
    }
  }
  CHECK(decoded >= 80);
}

TEST_CASE("One process decodes all pictures of a session") {
  ReaderSession session("read_pictures", {});
  const Bytes good = test::png_bytes(2, 2, 8, {0, 10, 20, 255});
  for (int i = 0; i < 20; ++i) {
    CHECK(unpack_height_map(session.request(pack_request(PictureKind::kHeightMap, good))).at(1, 0) == 1);
    CHECK_THROWS_WITH(session.request(pack_request(PictureKind::kHeightMap, Bytes{1, 2, 3})), "it is not a PNG file");
    CHECK_THROWS_WITH(session.request({}), "it is empty");
  }
  CHECK(session.started() == 1);
}

TEST_CASE("An answer of a reader that is no picture within the limits is rejected") {
  HeightMap map{3, 2, 255, {0, 1, 2, 3, 4, 255}};
  const Bytes whole = pack(map);
  CHECK(unpack_height_map(whole).levels == map.levels);
  for (std::size_t size = 0; size < whole.size(); ++size) CHECK_THROWS_AS(unpack_height_map(std::span(whole).first(size)), std::runtime_error);
  const auto rejected = [](HeightMap changed) {
    CHECK_THROWS_WITH(unpack_height_map(pack(changed)), "its reader returned no valid picture");
  };
  for (const int side : {-1, 0, 1, 4, kMaxHeightMapSide + 1, INT32_MAX}) {
    HeightMap changed = map;
    changed.columns = side;
    rejected(changed);
  }
  for (const int white : {0, -1, 254, 65536}) {
    HeightMap changed = map;
    changed.white = white;
    rejected(changed);
  }
  map.levels[0] = 256;
  rejected(map);

  const Raster raster{2, 1, true, Bytes(8, 7)};
  const Bytes pixels = pack(raster);
  CHECK(unpack_raster(pixels).rgba == raster.rgba);
  CHECK(unpack_raster(pixels).translucent);
  for (std::size_t size = 0; size < pixels.size(); ++size) CHECK_THROWS_AS(unpack_raster(std::span(pixels).first(size)), std::runtime_error);
  for (const int side : {-1, 0, 1, 3, kMaxRasterSide + 1, INT32_MAX}) {
    Raster changed = raster;
    changed.width = side;
    CHECK_THROWS_WITH(unpack_raster(pack(changed)), "its reader returned no valid picture");
  }
}
