#include "visual_node/frame/room_delay.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tactus;
using namespace tactus::visual;
using std::chrono::milliseconds;

namespace {
constexpr RoomTime kRoomBegin = room_time(10'000'000'000);
}

TEST_CASE("The delay slews to its target by 5 % of the elapsed time") {
  RoomDelay delay;
  CHECK(delay.at(kRoomBegin, kRoomBegin) == milliseconds(0));
  delay.request(kRoomBegin, milliseconds(10));
  CHECK(delay.at(kRoomBegin + milliseconds(100), kRoomBegin + milliseconds(80)) == milliseconds(5));
  CHECK(delay.at(kRoomBegin + milliseconds(300), kRoomBegin + milliseconds(280)) == milliseconds(10));
  delay.request(kRoomBegin + milliseconds(400), milliseconds(4));
  // Requested after `by`: valid for a later frame.
  CHECK(delay.at(kRoomBegin + milliseconds(410), kRoomBegin + milliseconds(390)) == milliseconds(10));
  CHECK(delay.at(kRoomBegin + milliseconds(500), kRoomBegin + milliseconds(480)) == milliseconds(5));
  CHECK(delay.at(kRoomBegin + milliseconds(1000), kRoomBegin + milliseconds(980)) == milliseconds(4));
}

TEST_CASE(
    "Two walls with different sampling times have the same delay at the same time") {
  std::mt19937 random(6);
  for (int trial = 0; trial < 50; ++trial) {
    RoomDelay often, seldom;
    int received = 0;
    std::vector<sync::Nanoseconds> asked;
    for (int i = 0; i < 40; ++i) asked.push_back(milliseconds(random() % 3 ? 20 : random() % 60));
    for (int frame = 0; frame < 230; ++frame) {
      const RoomTime due = kRoomBegin + frame * sync::Nanoseconds(16'666'667), by = due - milliseconds(25);
      // PLAYOUT at 10 Hz; the first wall receives it some frames before the other.
      for (; received < 40 && kRoomBegin + milliseconds(100) * received <= due - milliseconds(5); ++received)
        often.request(kRoomBegin + milliseconds(100) * received, asked[static_cast<std::size_t>(received)]);
      const sync::Nanoseconds a = often.at(due, by);
      if (frame % 7) continue;
      for (int i = 0; i < 40 && kRoomBegin + milliseconds(100) * i <= by; ++i)
        seldom.request(kRoomBegin + milliseconds(100) * i, asked[static_cast<std::size_t>(i)]);
      REQUIRE(seldom.at(due, by) == a);
    }
  }
}
