#include "visual_node/frame/marker.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "tests/visual_node/support/read_marker.h"
#include "visual_node/frame/text.h"

using namespace tactus::test;
using namespace tactus::visual;

namespace {
// Paints the rectangles of an overlay into luma.
std::vector<std::uint8_t> paint(const std::vector<Rect>& overlay, int width, int height) {
  std::vector<std::uint8_t> luma(static_cast<std::size_t>(width * height), 90);
  for (const Rect& r : overlay)
    for (int y = static_cast<int>(r.y); y < static_cast<int>(r.y + r.height); ++y)
      for (int x = static_cast<int>(r.x); x < static_cast<int>(r.x + r.width); ++x)
        luma[static_cast<std::size_t>(y * width + x)] = static_cast<std::uint8_t>(16 + 219 * r.red);
  return luma;
}
}  // namespace

TEST_CASE("A marker is decoded from the picture, also with compression noise") {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> noise(-60, 60);
  for (int trial = 0; trial < 300; ++trial) {
    const auto frame = static_cast<std::uint32_t>(random() & 0xffffff);
    std::vector<std::int64_t> events;
    for (unsigned i = random() % 15; i > 0; --i)
      events.push_back(static_cast<std::int64_t>(random()) << 32 | random());
    std::vector<Rect> overlay;
    append_marker(overlay, frame, events, 480);
    auto luma = paint(overlay, 640, 480);
    for (auto& pixel : luma) pixel = static_cast<std::uint8_t>(std::clamp(pixel + noise(random), 0, 255));
    const auto shown = std::min<std::size_t>(events.size(), kMarkerRows);
    for (std::size_t row = 0; row < std::max<std::size_t>(shown, 1); ++row) {
      const auto read = read_marker(luma, 640, 480, static_cast<int>(row));
      REQUIRE(read);
      CHECK(read->frame == frame);
      CHECK(read->event == (row < shown ? static_cast<std::uint32_t>(events[row]) : 0u));
    }
    if (shown < kMarkerRows)
      CHECK_FALSE(read_marker(luma, 640, 480, static_cast<int>(std::max<std::size_t>(shown, 1))));
  }
}

TEST_CASE("A marker with any one or two inverted cells is rejected") {
  std::vector<Rect> overlay;
  append_marker(overlay, 123456, std::vector<std::int64_t>{0xdeadbeef}, 480);
  const std::vector<bool> good = read_cells(paint(overlay, 640, 480), 640, 480, 0);
  REQUIRE(decode_marker(good));
  for (std::size_t a = 0; a < good.size(); ++a)
    for (std::size_t b = a; b < good.size(); ++b) {
      std::vector<bool> bad = good;
      bad[a].flip();
      if (b != a) bad[b].flip();
      CHECK_FALSE(decode_marker(bad));
    }
}

TEST_CASE("Every letter of the status words has its own glyph") {
  for (char a = '!'; a <= '~'; ++a)
    for (char b = '!'; b < a; ++b)
      if (glyph(a) && glyph(b)) CHECK_FALSE(std::equal(glyph(a), glyph(a) + kGlyphHeight, glyph(b)));
  CHECK(glyph('\n') == nullptr);
  std::vector<Rect> overlay;
  append_text(overlay, "HELD", 8, 8, 2);
  const Rect& plate = overlay.front();
  for (const Rect& r : overlay) {
    CHECK(r.x >= plate.x);
    CHECK(r.x + r.width <= plate.x + plate.width);
    CHECK(r.y + r.height <= plate.y + plate.height);
  }
}
