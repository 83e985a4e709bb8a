#include "visual_node/overlay/question_desk.h"

#include <catch2/catch.hpp>
#include <tactus/answer_t.hpp>
#include <tactus/question_t.hpp>

#include "lcmtypes/valid.h"
#include "tests/visual_node/support/question_messages.h"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::visual;

namespace {

constexpr int kLeft = 263, kRight = 262, kUp = 265, kDown = 264, kEnter = 257;

struct Desk {
  QuestionDesk desk{7};
  void ask(const question_t& m, std::int64_t ms) {
    desk.push(m, at_ms(ms));
    desk.seen(at_ms(ms + 5));
  }
  bool key(int key, std::int64_t ms) { return desk.press(press_of(key).value(), "key", at_ms(ms)); }
  answer_t sent() {
    auto a = desk.take_answer();
    REQUIRE(a);
    a->header.run_id = a->header.incarnation = 1;
    CHECK(valid(*a));
    CHECK_FALSE(desk.take_answer());
    return *a;
  }
};

}  // namespace

TEST_CASE("A choice is answered by its digit, once, from when it was seen") {
  Desk d;
  d.ask(choice(11, {"yes", "no"}), 1000);
  REQUIRE(d.desk.on(at_ms(1100)));
  CHECK(d.key('3', 1100));  // there is no third
  CHECK(d.key(kEnter, 1100));
  CHECK_FALSE(d.desk.take_answer());
  CHECK(d.key('2', 1355));
  const answer_t a = d.sent();
  CHECK((a.id == 11 && a.choice == 1 && a.number == 0 && a.after_ns == 350'000'000 && a.by == "key"));
  CHECK_FALSE(d.desk.on(at_ms(1356)));
  CHECK(d.key('1', 1400));  // is swallowed, and changes nothing
  CHECK_FALSE(d.desk.take_answer());
}

TEST_CASE("An answer is sent again for each repetition of its question, which is never shown again") {
  Desk d;
  d.ask(choice(11, {"yes", "no"}, 0), 1000);
  d.key('1', 1100);
  d.sent();
  for (int i = 1; i < 4; ++i) {
    d.desk.push(choice(11, {"yes", "no"}, i), at_ms(1000 + 200 * i));
    CHECK_FALSE(d.desk.on(at_ms(1000 + 200 * i)));
    CHECK(d.sent().choice == 0);
  }
  d.desk.push(question(12, question_t::NOTHING, 4), at_ms(1800));
  CHECK_FALSE(d.desk.take_answer());
  d.desk.push(choice(11, {"yes", "no"}, 5), at_ms(2000));
  CHECK_FALSE(d.desk.on(at_ms(2000)));
  CHECK(d.sent().choice == 0);
  // Who leads is started anew and counts from the beginning: that is another question.
  question_t anew = choice(11, {"yes", "no"}, 0);
  anew.header.incarnation = 2;
  d.desk.push(anew, at_ms(2200));
  CHECK(d.desk.on(at_ms(2200)));
  CHECK_FALSE(d.desk.take_answer());
}

TEST_CASE("Before a question was seen nothing answers it") {
  Desk d;
  d.desk.push(choice(1, {"yes", "no"}), at_ms(0));
  CHECK(d.key('1', 1));
  CHECK_FALSE(d.desk.take_answer());
  d.desk.seen(at_ms(20));
  CHECK(d.key('1', 10));  // pressed before the display had it
  CHECK(d.sent().after_ns == 0);
}

TEST_CASE("What was to be read is read with Enter, space or A, and with no digit") {
  for (const int key : {kEnter, static_cast<int>(' ')}) {
    Desk d;
    d.ask(question(5, question_t::READ), 0);
    d.key('1', 50);
    CHECK_FALSE(d.desk.take_answer());
    d.key(key, 105);
    const answer_t a = d.sent();
    CHECK((a.choice == -1 && a.number == 0 && a.after_ns == 100'000'000));
  }
  Desk d;
  d.ask(question(5, question_t::READ), 0);
  d.desk.press(press_of(Button::kB), "gamepad", at_ms(50));
  CHECK_FALSE(d.desk.take_answer());
  d.desk.press(press_of(Button::kA), "gamepad", at_ms(60));
  CHECK(d.sent().by == "gamepad");
}

TEST_CASE("A number begins in the middle, and arrows move its mark, finely and by a tenth, as far as its ends") {
  Desk d;
  d.ask(number(5, -1, 1, 0.05), 0);
  CHECK(d.desk.number() == Approx(0).margin(1e-9));
  d.key(kRight, 10);
  CHECK(d.desk.number() == Approx(0.05));
  d.key(kUp, 10);
  CHECK(d.desk.number() == Approx(0.25));
  d.key(kDown, 10), d.key(kLeft, 10), d.key(kLeft, 10);
  CHECK(d.desk.number() == Approx(-0.05));
  for (int i = 0; i < 30; ++i) d.key(kUp, 10);
  CHECK(d.desk.number() == 1);
  d.key(' ', 20);
  CHECK_FALSE(d.desk.take_answer());
  d.key(kEnter, 20);
  const answer_t a = d.sent();
  CHECK((a.number == 1 && a.choice == -1));
  d.ask(number(6, -1, 1, 0.05, 1), 500);
  CHECK(d.desk.number() == Approx(0).margin(1e-9));  // the next begins anew
}

TEST_CASE("Whatever range a number has, both its ends are answered and nothing beyond them") {
  for (const auto& [low, high, step] : std::vector<std::tuple<double, double, double>>{
           {0, 10, 1}, {0, 10, 3}, {1, 7, 6}, {-1e9, 1e9, 1e-300}, {0, 1e-9, 1e-9}, {20.5, 36, 0.25}}) {
    CAPTURE(low, high, step);
    Desk d;
    d.ask(number(5, low, high, step), 0);
    CHECK((d.desk.number() >= low && d.desk.number() <= high));
    for (int i = 0; i < 20; ++i) d.key(kUp, 10);
    CHECK(d.desk.number() == Approx(high));
    CHECK(d.desk.number() <= high);
    for (int i = 0; i < 20; ++i) d.key(kDown, 10);
    CHECK(d.desk.number() == low);
  }
}

TEST_CASE("A question is gone two seconds after it was said last, and when nothing is asked") {
  Desk d;
  d.ask(choice(1, {"yes", "no"}, 0), 0);
  CHECK(d.desk.on(at_ms(2000)));
  CHECK_FALSE(d.desk.on(at_ms(2001)));
  CHECK_FALSE(d.key('1', 2001));  // a key is the window's again
  d.ask(choice(2, {"yes", "no"}, 1), 3000);
  CHECK(d.desk.on(at_ms(3100)));
  d.ask(question(3, question_t::NOTHING, 2), 3200);
  CHECK_FALSE(d.desk.on(at_ms(3200)));
  CHECK(d.key('1', 3300));  // a trial is under way: a key pressed too early lays no overlay
  CHECK_FALSE(d.desk.take_answer());
}

TEST_CASE("Of one who leads the newest holds. Another run and a second leader are not heeded while one leads") {
  Desk d;
  d.ask(choice(1, {"yes", "no"}, 5), 0);
  d.desk.push(choice(2, {"a", "b"}, 4), at_ms(10));  // overtaken
  CHECK(d.desk.on(at_ms(10))->id == 1);
  question_t other = choice(3, {"a", "b"}, 6);
  other.header.run_id = 8;
  d.desk.push(other, at_ms(20));
  CHECK(d.desk.on(at_ms(20))->id == 1);
  other.header.run_id = 7, other.header.source = 4;
  d.desk.push(other, at_ms(30));
  CHECK(d.desk.on(at_ms(30))->id == 1);
  d.desk.push(other, at_ms(2100));
  CHECK(d.desk.on(at_ms(2100))->id == 3);
}

TEST_CASE("A question in place of one that was not answered is seen and counted anew") {
  Desk d;
  d.ask(choice(1, {"yes", "no"}, 0), 0);
  d.ask(choice(2, {"a", "b", "c"}, 1), 1000);
  d.desk.seen(at_ms(1200));  // a later frame
  d.key('3', 1105);
  const answer_t a = d.sent();
  CHECK((a.id == 2 && a.choice == 2 && a.after_ns == 100'000'000));
}

TEST_CASE("Digits of either block choose, and what has no meaning to a question is the window's") {
  for (int i = 0; i < 9; ++i) {
    CHECK(press_of('1' + i)->choice == i);
    CHECK(press_of(321 + i)->choice == i);
  }
  for (const int key : {static_cast<int>('H'), static_cast<int>('R'), static_cast<int>('0'), 256, 300, 320, 330})
    CHECK_FALSE(press_of(key));
  CHECK(press_of(Button::kY).choice == 3);
  CHECK(press_of(Button::kLeft).fine == -1);
  CHECK(press_of(Button::kUp).coarse == 1);
}
