// Tests of publishing a question and accepting its answer.
#include "scripts/trial_runner/interview.h"

#include <catch2/catch.hpp>
#include <tactus/answer_t.hpp>
#include <tactus/question_t.hpp>

#include "lcmtypes/utf8.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::trial_runner;
using tactus::test::at_ms;

namespace {

question_t choice(int count) {
  question_t q{};
  q.kind = question_t::CHOICE, q.text = "Together?", q.count = count;
  for (int i = 0; i < count; ++i) q.choices.push_back(std::string(1, static_cast<char>('a' + i)));
  q.trial = 5;
  return q;
}

}  // namespace

TEST_CASE("A question is published at once and every 200 ms until it is answered") {
  Interview interview(1);
  interview.ask(choice(2));
  const auto first = interview.step(at_ms(1000));
  REQUIRE(first.size() == 1);
  const std::int64_t id = first[0].id;
  CHECK(interview.step(at_ms(1100)).empty());
  const auto again = interview.step(at_ms(1200));
  REQUIRE(again.size() == 1);
  CHECK(again[0].id == id);
  const auto a = interview.answer(1, 0, "button", at_ms(1300));
  REQUIRE(a);
  CHECK(a->after_ns == 300'000'000);
  REQUIRE(interview.accept(*a));
  CHECK_FALSE(interview.accept(*a));
  CHECK_FALSE(interview.is_open());
  const auto nothing = interview.step(at_ms(1301));
  REQUIRE(nothing.size() == 1);
  CHECK(nothing[0].kind == question_t::NOTHING);
  CHECK(nothing[0].trial == 5);
  CHECK(nothing[0].id != id);
}

TEST_CASE("An answer to another question, or with an unknown choice, is rejected") {
  Interview interview(1);
  interview.ask(choice(2));
  interview.step(at_ms(0));
  answer_t a = *interview.answer(0, 0, "key", at_ms(10));
  ++a.id;
  CHECK_FALSE(interview.accept(a));
  --a.id, a.choice = 2;
  CHECK_FALSE(interview.accept(a));
  a.choice = -1;
  CHECK_FALSE(interview.accept(a));
  CHECK_FALSE(interview.answer(2, 0, "button", at_ms(20)));
  CHECK(interview.is_open());
}

TEST_CASE("A question cannot be answered before it is published") {
  Interview interview(1);
  interview.ask(choice(2));
  CHECK_FALSE(interview.answer(0, 0, "button", at_ms(0)));
}

TEST_CASE("A number out of range is rejected") {
  Interview interview(1);
  question_t q{};
  q.kind = question_t::NUMBER, q.text = "How warm?", q.lowest = 20, q.highest = 40, q.step = 0.5;
  interview.ask(q);
  interview.step(at_ms(0));
  CHECK_FALSE(interview.accept(*interview.answer(0, 19, "page", at_ms(1))));
  CHECK_FALSE(interview.accept(*interview.answer(0, NAN, "page", at_ms(1))));
  CHECK(interview.accept(*interview.answer(0, 40, "page", at_ms(1))));
}

TEST_CASE("A question without a possible answer is rejected, and the previous question stays") {
  Interview interview(1);
  interview.ask(choice(3));
  CHECK_THROWS_AS(interview.ask(choice(1)), std::invalid_argument);
  CHECK_THROWS_AS(interview.ask(choice(10)), std::invalid_argument);
  CHECK(interview.question().count == 3);
}

TEST_CASE("A question in any language is asked, and a large one in several messages") {
  Interview interview(1);
  question_t q = choice(2);
  q.text = "\xe0\xa4\x95\xe0\xa5\x8d\xe0\xa4\xaf\xe0\xa4\xbe?", q.choices = {"\xd0\xb4\xd0\xb0", "\xd9\x84\xd8\xa7"};
  interview.ask(q);
  const auto small = interview.step(at_ms(0));
  REQUIRE(small.size() == 1);
  CHECK(small[0].text == q.text);
  for (q.text.clear(); q.text.size() < 1800;) q.text += "\xe0\xa4\xa8";
  interview.ask(q);
  CHECK(interview.question().text == q.text);
  CHECK(interview.step(at_ms(10)).size() == 2);
  CHECK(interview.step(at_ms(209)).empty());
  CHECK(interview.step(at_ms(210)).size() == 2);
  // The quoted part of a text that is too long ends between two characters.
  q.text += "\xe0\xa4\xa8";
  try {
    interview.ask(q);
    FAIL("asked");
  } catch (const std::invalid_argument& e) {
    CHECK(tactus::is_text_line(e.what()));
  }
}
