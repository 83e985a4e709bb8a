// Tests of reading height maps from PNG.
#include "sync/pictures/picture_decoders.h"

#include <catch2/catch.hpp>
#include <stdexcept>

#include "tests/grey_png.h"

using namespace tactus;
using sync::read_height_map;
using test::png_bytes;

TEST_CASE("A grey image has heights from 0 to 1, its lowest row first") {
  const HeightMap map = read_height_map(png_bytes(3, 2, 8, {255, 0, 0, 0, 0, 51}));
  CHECK(map.columns == 3);
  CHECK(map.rows == 2);
  CHECK(map.at(0, 1) == 1);
  CHECK(map.at(2, 0) == Approx(0.2));
  SECTION("sixteen-bit samples keep their resolution") {
    CHECK(read_height_map(png_bytes(2, 2, 16, {0, 0, 0, 1, 0x80, 0, 0xff, 0xff})).at(1, 1) == Approx(1 / 65535.0));
  }
}

TEST_CASE("Data that is not a height map is rejected, also if it is truncated") {
  CHECK_THROWS_WITH(read_height_map({}), Catch::Contains("not a PNG"));
  CHECK_THROWS_WITH(read_height_map(png_bytes(2, 2, 8, std::vector<std::uint8_t>(12), PNG_COLOR_TYPE_RGB)),
                    Catch::Contains("grey"));
  CHECK_THROWS_WITH(read_height_map(png_bytes(1, 2, 8, {0, 0})), Catch::Contains("samples"));
  CHECK_THROWS_WITH(read_height_map(png_bytes(5000, 2, 8, std::vector<std::uint8_t>(10'000))),
                    Catch::Contains("4097"));
  const auto whole = png_bytes(20, 20, 8, std::vector<std::uint8_t>(400, 7));
  // The last 12 bytes are the end marker; the samples are complete without them.
  for (std::size_t length = 0; length < whole.size() - 12; ++length)
    CHECK_THROWS_AS(read_height_map(std::span(whole).first(length)), std::runtime_error);
  for (std::size_t i = 0; i < whole.size() - 12; ++i) {
    auto damaged = whole;
    damaged[i] ^= 0x40;
    try {
      read_height_map(damaged);  // a byte without effect
    } catch (const std::runtime_error&) {
    }
  }
}
