#include "sync/pictures/picture_decoders.h"

#include <catch2/catch.hpp>
#include <csetjmp>
#include <cstdio>
#include <random>
#include <stdexcept>

#include <jpeglib.h>

#include "tests/grey_png.h"

using namespace tactus;
using sync::Raster;
using sync::read_raster;

namespace {

using Bytes = std::vector<std::uint8_t>;

// Three by two: red, green, blue over white, grey, black.
const Bytes kColours{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 128, 128, 128, 0, 0, 0};

// rgb: rows from the top.
Bytes jpeg_bytes(unsigned width, unsigned height, const Bytes& rgb) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &out, &size);
  jpeg.image_width = width, jpeg.image_height = height, jpeg.input_components = 3, jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  for (unsigned y = 0; y < height; ++y) {
    JSAMPROW row = const_cast<JSAMPROW>(&rgb[std::size_t{3} * width * y]);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  Bytes bytes(out, out + size);
  jpeg_destroy_compress(&jpeg);
  free(out);
  return bytes;
}

// Left half of one colour and right half of another, so that the loss of JPEG is small.
Bytes halves(unsigned side) {
  Bytes rgb;
  for (unsigned y = 0; y < side; ++y)
    for (unsigned x = 0; x < side; ++x)
      for (const int c : y < side / 2 ? std::array{200, 40, 60} : std::array{30, 90, 220})
        rgb.push_back(static_cast<std::uint8_t>(c));
  return rgb;
}

// Either it throws one clause, or it returns a picture with all of its pixels.
void survives(const Bytes& bytes) {
  try {
    const Raster r = read_raster(bytes);
    REQUIRE(r.rgba.size() == static_cast<std::size_t>(4 * r.width * r.height));
    REQUIRE(r.width >= 1);
    REQUIRE(r.width <= 4096);
  } catch (const std::runtime_error& e) {
    REQUIRE(std::string(e.what()).size() > 10);
    REQUIRE(std::string(e.what()).find('\n') == std::string::npos);
  }
}

}  // namespace

TEST_CASE("A PNG is read with its lowest row first and its translucency") {
  const Raster r = read_raster(test::png_bytes(3, 2, 8, kColours, PNG_COLOR_TYPE_RGB));
  CHECK(r.width == 3);
  CHECK(r.height == 2);
  CHECK_FALSE(r.translucent);
  CHECK(r.rgba == Bytes{255, 255, 255, 255, 128, 128, 128, 255, 0, 0, 0,   255,
                        255, 0,   0,   255, 0,   255, 0,   255, 0, 0, 255, 255});
  const Raster clear = read_raster(test::png_bytes(2, 1, 8, {1, 2, 3, 255, 4, 5, 6, 254}, PNG_COLOR_TYPE_RGBA));
  CHECK(clear.translucent);
  CHECK(clear.rgba == Bytes{1, 2, 3, 255, 4, 5, 6, 254});
  CHECK_FALSE(read_raster(test::png_bytes(1, 1, 8, {1, 2, 3, 255}, PNG_COLOR_TYPE_RGBA)).translucent);
}

TEST_CASE("Grey pictures are read") {
  CHECK(read_raster(test::png_bytes(2, 1, 8, {7, 200})).rgba == Bytes{7, 7, 7, 255, 200, 200, 200, 255});
}

TEST_CASE("A JPEG is read with its lowest row first") {
  const Raster r = read_raster(jpeg_bytes(32, 32, halves(32)));
  REQUIRE(r.width == 32);
  REQUIRE(r.height == 32);
  CHECK_FALSE(r.translucent);
  // Quality 100 is within a few levels away from edges.
  const auto near = [&](int x, int y, int red, int green, int blue) {
    const std::uint8_t* at = &r.rgba[static_cast<std::size_t>(4 * (32 * y + x))];
    return std::abs(at[0] - red) <= 3 && std::abs(at[1] - green) <= 3 && std::abs(at[2] - blue) <= 3 &&
           at[3] == 255;
  };
  CHECK(near(5, 4, 30, 90, 220));
  CHECK(near(20, 27, 200, 40, 60));
}

TEST_CASE("Data that is not a picture is rejected with the reason") {
  CHECK_THROWS_WITH(read_raster({}), Catch::Contains("neither a PNG nor a JPEG"));
  const Bytes text{'h', 'e', 'l', 'l', 'o', ' ', 'w', 'o', 'r', 'l', 'd'};
  CHECK_THROWS_WITH(read_raster(text), Catch::Contains("neither a PNG nor a JPEG"));
}

TEST_CASE("A truncated picture is rejected, and a corrupted one is rejected or decoded") {
  const Bytes png = test::png_bytes(3, 2, 8, kColours, PNG_COLOR_TYPE_RGB), jpeg = jpeg_bytes(16, 16, halves(16));
  // Without the empty last chunk of a PNG or the end marker of a JPEG the picture may be complete.
  for (std::size_t length = 0; length < png.size() - 12; ++length) {
    INFO(length << " of " << png.size() << " bytes of PNG");
    CHECK_THROWS(read_raster(std::span(png).first(length)));
  }
  for (std::size_t length = 0; length + 3 < jpeg.size(); ++length) {
    INFO(length << " of " << jpeg.size() << " bytes of JPEG");
    CHECK_THROWS(read_raster(std::span(jpeg).first(length)));
  }
  std::minstd_rand random(1);
  for (const Bytes& whole : {png, jpeg})
    for (int i = 0; i < 500; ++i) {
      Bytes mangled = whole;
      for (int k = 0; k < 3; ++k) mangled[random() % mangled.size()] = static_cast<std::uint8_t>(random());
      survives(mangled);
    }
}

TEST_CASE("A picture with too many pixels is rejected before memory is allocated") {
  // A row of 4097 pixels, and a header that claims 65,000 each way.
  CHECK_THROWS_WITH(read_raster(test::png_bytes(4097, 1, 8, Bytes(4097, 9))), Catch::Contains("4096"));
  CHECK(read_raster(test::png_bytes(4096, 1, 8, Bytes(4096, 9))).width == 4096);
  Bytes jpeg = jpeg_bytes(16, 16, halves(16));
  for (std::size_t i = 0; i + 8 < jpeg.size(); ++i)
    if (jpeg[i] == 0xff &&
        jpeg[i + 1] == 0xc0) {  // start of frame: length, precision, height, width (ITU-T T.81, B.2.2)
      jpeg[i + 5] = jpeg[i + 7] = 0xfd;
      break;
    }
  CHECK_THROWS_WITH(read_raster(jpeg), Catch::Contains("4096"));
}
