#include "visual_node/video/picture_stream.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <tactus/picture_chunk_t.hpp>
#include <thread>

extern "C" {
#include <jpeglib.h>
}

#include "lcmtypes/valid.h"
#include "sync/tools/picture_reader.h"

using namespace tactus;
using namespace tactus::visual;

namespace {

// Upper half of one colour, lower half black; the lowest row first.
std::vector<std::uint8_t> picture(int width, int height, int red, int green, int blue) {
  std::vector<std::uint8_t> rgba(static_cast<std::size_t>(width * height * 4), 255);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int values[] = {red, green, blue};
      for (int c = 0; c < 3; ++c)
        rgba[static_cast<std::size_t>((y * width + x) * 4 + c)] =
            static_cast<std::uint8_t>(y >= height / 2 ? values[c] : 0);
    }
  return rgba;
}

struct Decoded {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};
Decoded decode(const std::vector<std::uint8_t>& bytes) {
  jpeg_decompress_struct info;
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, bytes.data(), bytes.size());
  REQUIRE(jpeg_read_header(&info, TRUE) == JPEG_HEADER_OK);
  jpeg_start_decompress(&info);
  Decoded d{static_cast<int>(info.output_width), static_cast<int>(info.output_height), {}};
  d.rgb.resize(static_cast<std::size_t>(d.width * d.height * 3));
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = d.rgb.data() + info.output_scanline * info.output_width * 3;
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
  return d;
}

Jpeg some_jpeg(std::size_t bytes) {
  Jpeg j{64, 48, std::vector<std::uint8_t>(bytes)};
  for (std::size_t i = 0; i < bytes; ++i) j.bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 1024);
  return j;
}

std::vector<picture_chunk_t> sent(std::size_t bytes, std::int64_t number, int source = 1) {
  auto chunks = chunks_of(some_jpeg(bytes), number, 77, 88);
  for (picture_chunk_t& c : chunks) c.header.source = source, c.header.incarnation = 5, c.header.run_id = 1;
  return chunks;
}

sync::HostTime at_ms(int ms) { return sync::HostTime{std::chrono::milliseconds(ms)}; }

}  // namespace

TEST_CASE("A picture is encoded as an upright, smaller JPEG file") {
  const Jpeg jpeg = encode_jpeg(picture(640, 480, 250, 40, 10), 640, 480, 320, 75);
  const Decoded d = decode(jpeg.bytes);
  CHECK(d.width == 320);
  CHECK(d.height == 240);
  const auto at = [&](int x, int y, int c) {
    return int{d.rgb[static_cast<std::size_t>((y * d.width + x) * 3 + c)]};
  };
  // Flat colour: the quantisation error at this quality.
  CHECK(std::abs(at(160, 40, 0) - 250) <= 6);
  CHECK(std::abs(at(160, 40, 1) - 40) <= 6);
  CHECK(at(160, 200, 0) <= 6);
}

TEST_CASE("Pictures are never enlarged, keep their aspect ratio and reject invalid sizes") {
  const Jpeg jpeg = encode_jpeg(picture(64, 32, 9, 9, 9), 64, 32, 4096, 75);
  CHECK(jpeg.width == 64);
  CHECK(jpeg.height == 32);
  CHECK(encode_jpeg({}, 0, 0, 320, 75).bytes.empty());
  CHECK(encode_jpeg(std::vector<std::uint8_t>(16), 64, 64, 320, 75).bytes.empty());
  CHECK(encode_jpeg(picture(8, 8, 1, 1, 1), 8, 8, 0, 75).bytes.empty());
  CHECK(encode_jpeg(picture(64, 2, 9, 9, 9), 64, 2, 16, 75).height == 1);
}

TEST_CASE("Chunks of a picture are valid messages, and a receiver assembles them in any order") {
  for (const std::size_t bytes : {1u, 1024u, 1025u, 40000u}) {
    auto chunks = sent(bytes, 3);
    CHECK(chunks.size() == (bytes + 1023) / 1024);
    for (const picture_chunk_t& c : chunks) CHECK(valid(c));
    std::reverse(chunks.begin(), chunks.end());
    sync::PictureReader reader;
    std::optional<sync::StreamedPicture> whole;
    for (const picture_chunk_t& c : chunks) {
      CHECK_FALSE(whole);
      whole = reader.push(c);
    }
    REQUIRE(whole);
    CHECK(whole->jpeg == some_jpeg(bytes).bytes);
    CHECK(whole->sim_time_ns == 77);
    CHECK(whole->presented_ns == 88);
    CHECK(whole->picture == 3);
    for (const picture_chunk_t& c : chunks) CHECK_FALSE(reader.push(c));  // repeated
  }
}

TEST_CASE("A picture with a missing chunk is skipped, and the next one is complete") {
  sync::PictureReader reader;
  auto first = sent(5000, 0), second = sent(5000, 1);
  first.erase(first.begin() + 2);
  for (const auto& c : first) CHECK_FALSE(reader.push(c));
  int whole = 0;
  for (const auto& c : second) whole += reader.push(c).has_value();
  CHECK(whole == 1);
  CHECK(reader.skipped() == 1);
  CHECK_FALSE(reader.push(sent(5000, 0)[2]));  // too late
}

TEST_CASE("Two walls stream in parallel, and a restarted node is received again") {
  sync::PictureReader reader;
  const auto a = sent(3000, 9, 1), b = sent(3000, 2, 2);
  int whole = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    whole += reader.push(a[i]).has_value() + reader.push(b[i]).has_value();
  CHECK(whole == 2);
  auto again = sent(3000, 0, 1);
  for (auto& c : again) c.header.incarnation = 6, whole += reader.push(c).has_value();
  CHECK(whole == 3);
}

TEST_CASE("Inconsistent chunks are rejected, and the number of sources is limited") {
  sync::PictureReader reader;
  auto bad = sent(3000, 1);
  bad[0].chunks = 1 << 30;
  CHECK_FALSE(reader.push(bad[0]));
  bad[1].chunk = -1;
  CHECK_FALSE(reader.push(bad[1]));
  bad[2].size = 9;
  CHECK_FALSE(reader.push(bad[2]));
  picture_chunk_t part = sent(3000, 1)[0];
  part.size = 10, part.data.resize(10);  // not the last, and not full
  CHECK_FALSE(reader.push(part));
  for (int source = 0; source < 1000; ++source) reader.push(sent(3000, 1, source)[0]);
  int whole = 0;
  for (const auto& c : sent(3000, 1, 5000)) whole += reader.push(c).has_value();
  CHECK(whole == 1);
}

TEST_CASE("A stream sends a limited number of chunks per tick and drops pictures that do not fit") {
  Settings settings;
  settings.stream_Hz = 30;
  settings.stream_width = 640;
  settings.stream_quality = 100;
  PictureStream stream;
  CHECK(stream.take_chunks().empty());
  stream.begin(640, 480, settings);
  std::vector<std::uint8_t> noise(640 * 480 * 4);
  unsigned state = 1;
  for (std::uint8_t& byte : noise)
    byte = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
  int reads = 0;
  const auto read = [&](std::span<std::uint8_t> rgba) {
    ++reads;
    std::copy(noise.begin(), noise.end(), rgba.begin());
  };
  sync::PictureReader reader;
  std::vector<sync::StreamedPicture> got;
  for (int tick = 0; got.size() < 2 && tick < 2'000'000; ++tick) {
    stream.add(at_ms(tick), tick, at_ms(tick + 5), read);
    const auto chunks = stream.take_chunks();
    REQUIRE(chunks.size() <= PictureStream::kMaxChunksATick);
    for (picture_chunk_t c : chunks) {
      c.header.incarnation = 1;
      if (auto whole = reader.push(c)) got.push_back(std::move(*whole));
    }
    if (chunks.empty()) std::this_thread::yield();
  }
  REQUIRE(got.size() == 2);
  CHECK(decode(got[1].jpeg).width == 640);
  CHECK(got[1].picture > got[0].picture);
  CHECK(got[1].presented_ns == got[1].sim_time_ns * 1'000'000 + 5'000'000);
  CHECK(reader.skipped() == 0);
  CHECK(reads >= 2);
}

TEST_CASE("A stream reads no more pictures than requested and none while it is off") {
  Settings settings;
  PictureStream stream;
  int reads = 0;
  const auto read = [&](std::span<std::uint8_t>) { ++reads; };
  stream.begin(16, 16, settings);
  for (int ms = 0; ms < 1000; ++ms) stream.add(at_ms(ms), 0, at_ms(ms), read);
  CHECK(reads == 0);
  settings.stream_Hz = 10;
  stream.begin(16, 16, settings);
  for (int ms = 0; ms < 2000; ++ms) stream.add(at_ms(ms), 0, at_ms(ms), read);
  CHECK(reads >= 1);
  CHECK(reads <= 21);  // 2 s at 10 Hz, both ends
}
