#include "visual_node/overlay/question_dialog.h"

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

struct Dialog {
  QuestionDialog dialog{7};
  void ask(const question_t& m, std::int64_t ms) {
    dialog.push(m, at_ms(ms));
    dialog.set_presented(at_ms(ms + 5));
  }
  bool key(int key, std::int64_t ms) { return dialog.press(question_input(key).value(), "key", at_ms(ms)); }
  answer_t sent() {
    auto a = dialog.take_answer();
    REQUIRE(a);
    a->header.run_id = a->header.incarnation = 1;
    CHECK(valid(*a));
    CHECK_FALSE(dialog.take_answer());
    return *a;
  }
};

}  // namespace

TEST_CASE("A choice is answered once by its digit, timed from its presentation") {
  Dialog d;
  d.ask(choice(11, {"yes", "no"}), 1000);
  REQUIRE(d.dialog.current(at_ms(1100)));
  CHECK(d.key('3', 1100));  // there is no third choice
  CHECK(d.key(kEnter, 1100));
  CHECK_FALSE(d.dialog.take_answer());
  CHECK(d.key('2', 1355));
  const answer_t a = d.sent();
  CHECK((a.id == 11 && a.choice == 1 && a.number == 0 && a.after_ns == 350'000'000 && a.by == "key"));
  CHECK_FALSE(d.dialog.current(at_ms(1356)));
  CHECK(d.key('1', 1400));  // consumed without effect
  CHECK_FALSE(d.dialog.take_answer());
}

TEST_CASE("An answer is repeated for each repetition of its question, which is not shown again") {
  Dialog d;
  d.ask(choice(11, {"yes", "no"}, 0), 1000);
  d.key('1', 1100);
  d.sent();
  for (int i = 1; i < 4; ++i) {
    d.dialog.push(choice(11, {"yes", "no"}, i), at_ms(1000 + 200 * i));
    CHECK_FALSE(d.dialog.current(at_ms(1000 + 200 * i)));
    CHECK(d.sent().choice == 0);
  }
  d.dialog.push(question(12, question_t::NOTHING, 4), at_ms(1800));
  CHECK_FALSE(d.dialog.take_answer());
  d.dialog.push(choice(11, {"yes", "no"}, 5), at_ms(2000));
  CHECK_FALSE(d.dialog.current(at_ms(2000)));
  CHECK(d.sent().choice == 0);
  // The restarted trial runner counts from the beginning: this is another question.
  question_t restarted = choice(11, {"yes", "no"}, 0);
  restarted.header.incarnation = 2;
  d.dialog.push(restarted, at_ms(2200));
  CHECK(d.dialog.current(at_ms(2200)));
  CHECK_FALSE(d.dialog.take_answer());
}

TEST_CASE("A key press before a question is shown does not answer it") {
  Dialog d;
  d.dialog.push(choice(1, {"yes", "no"}), at_ms(0));
  CHECK(d.key('1', 1));
  CHECK_FALSE(d.dialog.take_answer());
  d.dialog.set_presented(at_ms(20));
  CHECK(d.key('1', 10));  // pressed before the display showed it
  CHECK(d.sent().after_ns == 0);
}

TEST_CASE("A text is confirmed with Enter, space or A, and not with a digit") {
  for (const int key : {kEnter, static_cast<int>(' ')}) {
    Dialog d;
    d.ask(question(5, question_t::READ), 0);
    d.key('1', 50);
    CHECK_FALSE(d.dialog.take_answer());
    d.key(key, 105);
    const answer_t a = d.sent();
    CHECK((a.choice == -1 && a.number == 0 && a.after_ns == 100'000'000));
  }
  Dialog d;
  d.ask(question(5, question_t::READ), 0);
  d.dialog.press(question_input(Button::kB), "gamepad", at_ms(50));
  CHECK_FALSE(d.dialog.take_answer());
  d.dialog.press(question_input(Button::kA), "gamepad", at_ms(60));
  CHECK(d.sent().by == "gamepad");
}

TEST_CASE("A number starts in the middle, and arrows move its mark by one step or a tenth") {
  Dialog d;
  d.ask(number(5, -1, 1, 0.05), 0);
  CHECK(d.dialog.number() == Approx(0).margin(1e-9));
  d.key(kRight, 10);
  CHECK(d.dialog.number() == Approx(0.05));
  d.key(kUp, 10);
  CHECK(d.dialog.number() == Approx(0.25));
  d.key(kDown, 10), d.key(kLeft, 10), d.key(kLeft, 10);
  CHECK(d.dialog.number() == Approx(-0.05));
  for (int i = 0; i < 30; ++i) d.key(kUp, 10);
  CHECK(d.dialog.number() == 1);
  d.key(' ', 20);
  CHECK_FALSE(d.dialog.take_answer());
  d.key(kEnter, 20);
  const answer_t a = d.sent();
  CHECK((a.number == 1 && a.choice == -1));
  d.ask(number(6, -1, 1, 0.05, 1), 500);
  CHECK(d.dialog.number() == Approx(0).margin(1e-9));  // the next question starts in the middle
}

TEST_CASE("Both ends of every number range can be answered and nothing beyond them") {
  for (const auto& [low, high, step] : std::vector<std::tuple<double, double, double>>{
           {0, 10, 1}, {0, 10, 3}, {1, 7, 6}, {-1e9, 1e9, 1e-300}, {0, 1e-9, 1e-9}, {20.5, 36, 0.25}}) {
    CAPTURE(low, high, step);
    Dialog d;
    d.ask(number(5, low, high, step), 0);
    CHECK((d.dialog.number() >= low && d.dialog.number() <= high));
    for (int i = 0; i < 20; ++i) d.key(kUp, 10);
    CHECK(d.dialog.number() == Approx(high));
    CHECK(d.dialog.number() <= high);
    for (int i = 0; i < 20; ++i) d.key(kDown, 10);
    CHECK(d.dialog.number() == low);
  }
}

TEST_CASE("A question disappears two seconds after its last message or when it ends") {
  Dialog d;
  d.ask(choice(1, {"yes", "no"}, 0), 0);
  CHECK(d.dialog.current(at_ms(2000)));
  CHECK_FALSE(d.dialog.current(at_ms(2001)));
  CHECK_FALSE(d.key('1', 2001));  // keys belong to the window again
  d.ask(choice(2, {"yes", "no"}, 1), 3000);
  CHECK(d.dialog.current(at_ms(3100)));
  d.ask(question(3, question_t::NOTHING, 2), 3200);
  CHECK_FALSE(d.dialog.current(at_ms(3200)));
  CHECK(d.key('1', 3300));  // during a trial an early key press toggles no overlay
  CHECK_FALSE(d.dialog.take_answer());
}

TEST_CASE("The newest question of a trial runner is shown, and other runs and trial runners are ignored") {
  Dialog d;
  d.ask(choice(1, {"yes", "no"}, 5), 0);
  d.dialog.push(choice(2, {"a", "b"}, 4), at_ms(10));  // an older message that arrived late
  CHECK(d.dialog.current(at_ms(10))->id == 1);
  question_t other = choice(3, {"a", "b"}, 6);
  other.header.run_id = 8;
  d.dialog.push(other, at_ms(20));
  CHECK(d.dialog.current(at_ms(20))->id == 1);
  other.header.run_id = 7, other.header.source = 4;
  d.dialog.push(other, at_ms(30));
  CHECK(d.dialog.current(at_ms(30))->id == 1);
  d.dialog.push(other, at_ms(2100));
  CHECK(d.dialog.current(at_ms(2100))->id == 3);
}

TEST_CASE("A question that replaces another one is timed from its own presentation") {
  Dialog d;
  d.ask(choice(1, {"yes", "no"}, 0), 0);
  d.ask(choice(2, {"a", "b", "c"}, 1), 1000);
  d.dialog.set_presented(at_ms(1200));  // a later frame
  d.key('3', 1105);
  const answer_t a = d.sent();
  CHECK((a.id == 2 && a.choice == 2 && a.after_ns == 100'000'000));
}

TEST_CASE("Digits of both key blocks are choices, and other keys go to the window") {
  for (int i = 0; i < 9; ++i) {
    CHECK(question_input('1' + i)->choice == i);
    CHECK(question_input(321 + i)->choice == i);
  }
  for (const int key : {static_cast<int>('H'), static_cast<int>('R'), static_cast<int>('0'), 256, 300, 320, 330})
    CHECK_FALSE(question_input(key));
  CHECK(question_input(Button::kY).choice == 3);
  CHECK(question_input(Button::kLeft).fine == -1);
  CHECK(question_input(Button::kUp).coarse == 1);
}
