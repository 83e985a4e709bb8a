#include "visual_node/frame/agreed_delay.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tactus;
using namespace tactus::visual;
using std::chrono::milliseconds;

namespace {
constexpr RoomTime kBegin = room_time(10'000'000'000);
}

TEST_CASE("The delay goes to what is asked for by 5 % of the time that passes, and stays there") {
  AgreedDelay delay;
  CHECK(delay.at(kBegin, kBegin) == milliseconds(0));
  delay.ask(kBegin, milliseconds(10));
  CHECK(delay.at(kBegin + milliseconds(100), kBegin + milliseconds(80)) == milliseconds(5));
  CHECK(delay.at(kBegin + milliseconds(300), kBegin + milliseconds(280)) == milliseconds(10));
  delay.ask(kBegin + milliseconds(400), milliseconds(4));
  // Asked for after `by`: of a later frame.
  CHECK(delay.at(kBegin + milliseconds(410), kBegin + milliseconds(390)) == milliseconds(10));
  CHECK(delay.at(kBegin + milliseconds(500), kBegin + milliseconds(480)) == milliseconds(5));
  CHECK(delay.at(kBegin + milliseconds(1000), kBegin + milliseconds(980)) == milliseconds(4));
}

TEST_CASE(
    "Two walls that look at other instants and hear at other times have the same delay at the same instant") {
  std::mt19937 random(6);
  for (int trial = 0; trial < 50; ++trial) {
    AgreedDelay often, seldom;
    int heard = 0;
    std::vector<sync::Nanoseconds> asked;
    for (int i = 0; i < 40; ++i) asked.push_back(milliseconds(random() % 3 ? 20 : random() % 60));
    for (int frame = 0; frame < 230; ++frame) {
      const RoomTime due = kBegin + frame * sync::Nanoseconds(16'666'667), by = due - milliseconds(25);
      // PLAYOUT of ten a second; the first wall hears it some frames before the other.
      for (; heard < 40 && kBegin + milliseconds(100) * heard <= due - milliseconds(5); ++heard)
        often.ask(kBegin + milliseconds(100) * heard, asked[static_cast<std::size_t>(heard)]);
      const sync::Nanoseconds a = often.at(due, by);
      if (frame % 7) continue;
      for (int i = 0; i < 40 && kBegin + milliseconds(100) * i <= by; ++i)
        seldom.ask(kBegin + milliseconds(100) * i, asked[static_cast<std::size_t>(i)]);
      REQUIRE(seldom.at(due, by) == a);
    }
  }
}
