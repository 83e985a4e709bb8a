// Tests of questions in pages.
#include "sync/node/question_pages.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "lcmtypes/channels.h"
#include "lcmtypes/page_limits.h"
#include "lcmtypes/utf8.h"
#include "lcmtypes/valid.h"
#include "sync/bus/decode.h"
#include "sync/node/current_question.h"
#include "tests/times.h"

using namespace tactus;
using namespace tactus::sync;
using tactus::test::at_ms;

namespace {

std::string letters(std::mt19937& dice, std::size_t count) {
  static constexpr const char* kLetters[] = {"a", "\xd1\x8f", "\xe0\xa4\xa8", "\xf0\x9d\x93\x90"};
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += kLetters[dice() % 4];
  return text;
}

question_t drawn_question(std::mt19937& dice, std::int64_t id) {
  question_t q{};
  q.header.sim_time_ns = -1;
  q.header.run_id = 7, q.header.source = 3, q.header.incarnation = 5;
  q.id = id, q.kind = question_t::CHOICE, q.text = letters(dice, 1 + dice() % 600);
  for (unsigned i = 2 + dice() % 8; i > 0; --i) q.choices.push_back(letters(dice, 1 + dice() % 40));
  q.count = static_cast<std::int32_t>(q.choices.size());
  q.trial = 4, q.condition = letters(dice, dice() % 65), q.progress = letters(dice, dice() % 65), q.hint = letters(dice, dice() % 65);
  q.pages = 1;
  return q;
}

void stamp(std::vector<question_t>& pages, std::int64_t& seq) {
  for (question_t& p : pages) p.header.seq = seq++;
}

bool same_contents(question_t a, const question_t& b) {
  a.header = b.header;
  return encode(a) == encode(b);
}

}  // namespace

TEST_CASE("A question of any size is restored from pages that fit a message, in any order and with losses") {
  std::mt19937 dice(1);
  std::int64_t seq = 0;
  QuestionReader reader;
  std::size_t largest = 0;
  for (int i = 1; i <= 300; ++i) {
    const question_t whole = drawn_question(dice, i);
    REQUIRE(valid(whole));
    std::optional<question_t> read;
    // Each repetition loses a third of its pages; pages of several repetitions complete the question.
    for (int repetition = 0; repetition < 60 && !read; ++repetition) {
      std::vector<question_t> pages = question_pages(whole);
      stamp(pages, seq);
      largest = std::max(largest, pages.size());
      std::shuffle(pages.begin(), pages.end(), dice);
      for (const question_t& page : pages) {
        CHECK(page.getEncodedSize() <= static_cast<int>(channels::kMaxMessageBytes));
        CHECK(valid(page));
        if (dice() % 3 == 0 || read) continue;
        read = reader.push(page);
      }
    }
    REQUIRE(read);
    CHECK(same_contents(*read, whole));
  }
  CHECK(largest >= 2);
}

TEST_CASE("The largest question fits the largest number of pages") {
  question_t q{};
  q.header.run_id = q.header.incarnation = 1;
  q.header.sim_time_ns = -1;
  const std::string script_a = "\xf0\x9d\x93\x90";
  const auto repeated = [&](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += script_a;
    return text;
  };
  q.id = 7, q.kind = question_t::CHOICE, q.count = 9, q.choices.assign(9, repeated(40));
  q.text = repeated(600), q.condition = q.progress = q.hint = repeated(64);
  REQUIRE(valid(q));
  const auto pages = question_pages(q);
  CHECK((pages.size() > 3 && pages.size() <= static_cast<std::size_t>(kMaxQuestionPages)));
  CHECK(std::all_of(pages.begin(), pages.end(), [](const question_t& p) { return valid(p); }));
}

TEST_CASE("A small question is one message as before") {
  std::mt19937 dice(1);
  question_t q = drawn_question(dice, 1);
  q.text = "Together?", q.choices = {"yes", "no"}, q.count = 2;
  const auto pages = question_pages(q);
  REQUIRE(pages.size() == 1);
  CHECK(same_contents(pages[0], q));
  q.pages = 0;  // of a log from before
  CHECK(QuestionReader().push(q));
}

TEST_CASE("Pages that do not make a valid question are dropped") {
  std::mt19937 dice(1);
  question_t whole = drawn_question(dice, 1);
  whole.text = letters(dice, 600), whole.choices.assign(9, letters(dice, 40)), whole.count = 9;
  std::vector<question_t> pages = question_pages(whole);
  REQUIRE(pages.size() >= 2);
  QuestionReader reader;
  // Forged: ten choices together.
  pages.back().choices.emplace_back("b"), ++pages.back().count;
  for (const question_t& page : pages) CHECK_FALSE(reader.push(page));
}

TEST_CASE("The current question is the newest whole one, and a part of the next does not replace it") {
  std::mt19937 dice(1);
  std::int64_t seq = 0;
  CurrentQuestion current(7);
  question_t small = drawn_question(dice, 1);
  small.text = "Together?", small.choices = {"yes", "no"}, small.count = 2;
  question_t large = drawn_question(dice, 2);
  large.text = letters(dice, 600), large.choices.assign(9, letters(dice, 40)), large.count = 9;
  std::vector<question_t> first = question_pages(small), second = question_pages(large);
  stamp(first, seq), stamp(second, seq);
  REQUIRE(second.size() >= 2);
  CHECK(current.push(first[0], at_ms(0)));
  for (std::size_t i = 0; i + 1 < second.size(); ++i) {
    CHECK_FALSE(current.push(second[i], at_ms(100)));
    CHECK(current.newest(at_ms(100))->id == 1);
  }
  CHECK(current.push(second.back(), at_ms(100)));
  CHECK(same_contents(*current.newest(at_ms(100)), large));
  // A repeated old page changes nothing, and a whole repetition keeps the question alive.
  CHECK_FALSE(current.push(second[0], at_ms(200)));
  stamp(second, seq);
  for (std::size_t i = 0; i < second.size(); ++i) CHECK(current.push(second[i], at_ms(1900)) == (i + 1 == second.size()));
  CHECK(current.newest(at_ms(3900)));
  CHECK_FALSE(current.newest(at_ms(3901)));
}
