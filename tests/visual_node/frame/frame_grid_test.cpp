#include "visual_node/frame/frame_grid.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tactus;
using namespace tactus::visual;

TEST_CASE("Frame k is due after k periods, exact to 1 ns after a hundred days") {
  for (const double rate_Hz : {60.0, 59.94, 120.0, 7.0}) {
    const FrameGrid grid(rate_Hz);
    INFO(rate_Hz);
    CHECK(sync::to_ns(grid.due(0)) == 0);
    const std::int64_t many = std::llround(100 * 86400 * rate_Hz);
    // The period is a double, accurate to 2^-53 relative; so is the product, which is rounded to 1 ns.
    const long double exact = static_cast<long double>(many) * 1e9L / static_cast<long double>(rate_Hz);
    CHECK(std::abs(static_cast<double>(static_cast<long double>(sync::to_ns(grid.due(many))) - exact)) <= 3);
  }
}

TEST_CASE("The first frame at or after a time is due then, and the previous one is not") {
  std::mt19937_64 random(3);
  for (const double rate_Hz : {60.0, 59.94, 240.0, 1.0}) {
    const FrameGrid grid(rate_Hz);
    for (int i = 0; i < 2000; ++i) {
      const RoomTime t = room_time(static_cast<std::int64_t>(random() % 9'000'000'000'000'000));
      const std::int64_t k = grid.first_due_at_or_after(t);
      REQUIRE(grid.due(k) >= t);
      REQUIRE(grid.due(k - 1) < t);
      REQUIRE(grid.first_due_at_or_after(grid.due(k)) == k);
    }
  }
}

TEST_CASE("Jitter of a wall neither repeats a frame nor moves back to an earlier one") {
  std::mt19937 random(4);
  for (int trial = 0; trial < 50; ++trial) {
    FrameGrid grid(60);
    std::int64_t last = -1, t = 1'000'000'000;
    for (int i = 0; i < 500; ++i) {
      if (i > 0) t = std::max(t, sync::to_ns(grid.due(last)));  // the picture was held until then
      t += static_cast<std::int64_t>(random() % 40'000'000);    // up to two and a half frames
      const std::int64_t tremble = static_cast<std::int64_t>(random() % 30'000'000) - 15'000'000;
      const RoomTime ready = room_time(t + tremble);
      const std::int64_t k = grid.select_next(ready);
      REQUIRE(k > last);
      // The frame is not due before the picture is ready, nor later than necessary.
      REQUIRE(grid.due(k) >= ready);
      REQUIRE((k == grid.first_due_at_or_after(ready) || k == last + 1));
      last = k;
    }
  }
}

TEST_CASE("A clock step back by more than a few frames restarts the numbering") {
  FrameGrid grid(60);
  const std::int64_t far = grid.select_next(room_time(100'000'000'000));
  CHECK(grid.select_next(grid.due(far - 2)) == far + 1);
  CHECK(grid.select_next(room_time(40'000'000'000)) == 2400);
  grid.restart();
  CHECK_FALSE(grid.last());
  CHECK(grid.select_next(room_time(1)) == 1);
}
