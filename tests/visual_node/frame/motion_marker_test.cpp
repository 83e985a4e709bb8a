#include "visual_node/frame/motion_marker.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <tactus/media_clock_t.hpp>

#include "tests/visual_node/support/read_marker.h"
#include "visual_node/frame/frame_times.h"
#include "visual_node/frame/marker.h"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::visual;

namespace {

constexpr int kVideoWidth = 320, kVideoHeight = 240;

// Paints the rectangles of an overlay into luma.
std::vector<std::uint8_t> paint(const std::vector<Rect>& overlay) {
  std::vector<std::uint8_t> luma(kVideoWidth * kVideoHeight, 90);
  for (const Rect& r : overlay)
    for (int y = static_cast<int>(r.y); y < static_cast<int>(r.y + r.height); ++y)
      for (int x = static_cast<int>(r.x); x < static_cast<int>(r.x + r.width); ++x)
        luma[static_cast<std::size_t>(y * kVideoWidth + x)] = static_cast<std::uint8_t>(16 + 219 * r.red);
  return luma;
}

}  // namespace

TEST_CASE(
    "The samples of a frame are decoded beside its events, also with compression noise") {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> noise(-60, 60);
  for (int trial = 0; trial < 200; ++trial) {
    const auto frame = static_cast<std::uint32_t>(random() & 0xffffff);
    std::vector<std::int64_t> events(random() % 15, 77);
    std::vector<PoseSample> samples;
    for (int tool = 0; tool < static_cast<int>(random() % 6); ++tool)
      samples.push_back({tool, static_cast<std::int64_t>(random() << 8 | random())});
    std::vector<Rect> overlay;
    append_marker(overlay, frame, events, kVideoHeight);
    append_motion_marker(overlay, frame, samples, kVideoHeight);
    auto luma = paint(overlay);
    for (auto& pixel : luma) pixel = static_cast<std::uint8_t>(std::clamp(pixel + noise(random), 0, 255));
    REQUIRE(read_marker(luma, kVideoWidth, kVideoHeight, 0)->frame == frame);
    for (int row = 0; row < kMotionRows; ++row) {
      const auto read = read_motion_marker(luma, kVideoWidth, kVideoHeight, row);
      REQUIRE(read.has_value() == (row < static_cast<int>(samples.size())));
      if (!read) continue;
      const PoseSample& shown = samples[static_cast<std::size_t>(row)];
      CHECK(read->frame == frame);
      CHECK(read->tool == shown.tool);
      CHECK(read->sample == (static_cast<std::uint64_t>(shown.seq) & 0xfffffff));
    }
  }
}

TEST_CASE("Rows of events and rows of motion are not confused") {
  std::vector<Rect> overlay;
  append_marker(overlay, 5, std::vector<std::int64_t>(kMarkerRows + 4, 9), kVideoHeight);
  auto luma = paint(overlay);
  for (int row = 0; row < kMotionRows; ++row) CHECK_FALSE(read_motion_marker(luma, kVideoWidth, kVideoHeight, row));
  overlay.clear();
  append_motion_marker(overlay, 5, std::vector<PoseSample>(9), kVideoHeight);
  luma = paint(overlay);
  for (int row = 0; row < 2 * kMarkerRows; ++row) CHECK_FALSE(read_marker(luma, kVideoWidth, kVideoHeight, row));
  CHECK_FALSE(read_motion_marker(luma, kVideoWidth, kVideoHeight, kMotionRows));  // no further rows than samples
}

TEST_CASE("The stages of a frame have their own clocks, with the index of the video") {
  media_clock_t fence{};
  fence.medium = "video.mp4", fence.index = 12, fence.host_time_ns = 300;
  const auto pairs = stages_of(fence, {sync::host_time(100), sync::host_time(200), sync::host_time(400)});
  REQUIRE(pairs.size() == 3);
  CHECK(pairs[0].medium == "video.mp4#begun");
  CHECK(pairs[1].medium == "video.mp4#latched");
  CHECK(pairs[2].medium == "video.mp4#read");
  for (const media_clock_t& m : pairs) CHECK(m.index == 12);
  CHECK(pairs[0].host_time_ns == 100);
  CHECK(pairs[2].host_time_ns == 400);
}
