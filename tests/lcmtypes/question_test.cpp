// Tests of the validation of questions.
#include <catch2/catch.hpp>
#include <tactus/question_t.hpp>

#include "lcmtypes/page_limits.h"
#include "lcmtypes/valid.h"

using namespace tactus;

namespace {

question_t choice() {
  question_t q{};
  q.header.run_id = q.header.incarnation = 1;
  q.header.sim_time_ns = -1;
  q.id = 7, q.kind = question_t::CHOICE, q.text = "Together?", q.choices = {"yes", "no"}, q.count = 2;
  return q;
}

question_t number() {
  question_t q = choice();
  q.kind = question_t::NUMBER, q.choices.clear(), q.count = 0, q.lowest = -1, q.highest = 1, q.step = 0.1;
  return q;
}

}  // namespace

TEST_CASE("A question is one line of UTF-8, and its length counts characters") {
  const std::string ya = "\xd1\x8f", na = "\xe0\xa4\xa8";
  const auto repeated = [](const std::string& c, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += c;
    return text;
  };
  question_t q = choice();
  q.text = repeated(na, 600), q.choices = {repeated(ya, 40), na};
  CHECK(valid(q));
  q.text += na;
  CHECK_FALSE(valid(q));
  for (const char* wrong : {"\xff", "\xe0\xa4", "a\xc2\x85", "\xe2\x80\xa8"}) {
    for (std::string question_t::*text : {&question_t::text, &question_t::condition, &question_t::progress, &question_t::hint}) {
      question_t damaged = choice();
      damaged.*text = wrong;
      CHECK_FALSE(valid(damaged));
    }
    question_t damaged = choice();
    damaged.choices[1] = wrong;
    CHECK_FALSE(valid(damaged));
  }
  q = choice();
  q.choices[0] = repeated(ya, 41);
  CHECK_FALSE(valid(q));
}

TEST_CASE("A question without a valid answer is rejected") {
  CHECK(valid(choice()));
  CHECK(valid(number()));
  const auto refused = [](question_t q, auto change) {
    change(q);
    return !valid(q);
  };
  CHECK(refused(choice(), [](question_t& q) { q.id = 0; }));
  CHECK(refused(choice(), [](question_t& q) { q.choices.pop_back(), q.count = 1; }));
  CHECK(refused(choice(), [](question_t& q) { q.choices[1] = ""; }));
  CHECK(refused(choice(), [](question_t& q) { q.choices[1] = "n\no"; }));
  CHECK(refused(choice(), [](question_t& q) { q.text.assign(601, 'a'); }));
  CHECK(refused(choice(), [](question_t& q) { q.step = 1; }));
  CHECK(refused(choice(), [](question_t& q) { q.kind = question_t::NOTHING; }));
  CHECK(refused(choice(), [](question_t& q) { q.kind = 4; }));
  CHECK(refused(number(), [](question_t& q) { q.highest = q.lowest; }));
  CHECK(refused(number(), [](question_t& q) { q.step = 0; }));
  CHECK(refused(number(), [](question_t& q) { q.step = 2.1; }));
  CHECK(refused(number(), [](question_t& q) { q.hint.assign(65, 'a'); }));
  CHECK(refused(number(), [](question_t& q) { q.page = 1; }));
  CHECK(refused(number(), [](question_t& q) { q.page = -1; }));
  CHECK(refused(number(), [](question_t& q) { q.page = q.pages = 2; }));
  CHECK(refused(number(), [](question_t& q) { q.pages = kMaxQuestionPages + 1; }));
}
