// Tests of questions and answers between the bus and the live page.
#include "scripts/live/answers.h"

#include <catch2/catch.hpp>
#include <tactus/question_t.hpp>

#include "lcmtypes/valid.h"
#include "tests/live/live_time.h"
#include "tests/sync/support/memory_sink.h"

using namespace tactus;
using namespace tactus::live;
using tactus::test::at;

namespace {

constexpr std::int64_t kBig = 4'611'686'018'427'387'901;  // no double represents it

question_t question(int kind, std::int64_t seq = 0, std::int64_t id = kBig, std::int64_t run = 7) {
  question_t m{};
  m.header = sync::header_of("conductor", 5, seq, 1, run);
  m.id = id;
  m.kind = static_cast<std::int8_t>(kind);
  if (kind != question_t::NOTHING) m.text = "Which was first?";
  if (kind == question_t::CHOICE) m.count = 2, m.choices = {"sound", "flash"};
  if (kind == question_t::NUMBER) m.lowest = -1, m.highest = 1, m.step = 0.1;
  m.trial = 3, m.condition = "audio +80 ms", m.progress = "block 1 of 4";
  REQUIRE(valid(m));
  return m;
}

std::string rejection(Answers& answers, const PageAnswer& answer, sync::HostTime now) {
  try {
    answers.answer(answer, now);
  } catch (const std::invalid_argument& e) {
    CHECK(std::string(e.what()).find(';') != std::string::npos);  // the problem; the remedy
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("A page receives the question, and its answer carries the question's id and the kind of input") {
  Answers a(7);
  CHECK(a.to_json(at(0)).is_null());
  question_t asked = question(question_t::CHOICE);
  asked.hint = "Taste: die Zahl";
  a.push(asked, at(0));
  const auto shown = a.to_json(at(0.1));
  CHECK(shown["hint"] == "Taste: die Zahl");
  CHECK((shown["kind"] == "choice" && shown["text"] == "Which was first?" && shown["choices"][1] == "flash"));
  CHECK((shown["trial"] == 3 && shown["condition"] == "audio +80 ms" && shown["progress"] == "block 1 of 4"));
  CHECK(shown["answered"] == false);
  a.answer({shown["question"], 1, 0, 350'000'000}, at(0.4));
  const auto sent = a.take_answer();
  REQUIRE(sent);
  CHECK(valid(*sent));
  CHECK((sent->id == kBig && sent->choice == 1 && sent->number == 0 && sent->after_ns == 350'000'000 && sent->by == "page"));
  CHECK(a.to_json(at(0.5))["answered"] == true);
  CHECK_FALSE(a.take_answer());
}

TEST_CASE("An answer of a page is repeated for each repetition of its question, and not for the next question") {
  Answers a(7);
  a.push(question(question_t::CHOICE, 0), at(0));
  a.answer({a.to_json(at(0))["question"], 0, 0, 0}, at(0));
  CHECK(a.take_answer());
  a.push(question(question_t::CHOICE, 1), at(0.2));
  CHECK(a.take_answer());
  a.push(question(question_t::CHOICE, 2), at(0.4));
  a.push(question(question_t::READ, 3, 12), at(0.6));  // before the answer was accepted
  CHECK_FALSE(a.take_answer());
  CHECK(a.to_json(at(0.6))["answered"] == false);
}

TEST_CASE("An answer that fits no question is rejected with a reason, and is not published") {
  Answers a(7);
  CHECK_THAT(rejection(a, {"5.1", 0, 0, 0}, at(0)), Catch::Contains("no longer open"));
  a.push(question(question_t::CHOICE, 0), at(0));
  const std::string name = a.to_json(at(0))["question"];
  CHECK_THAT(rejection(a, {name + "0", 0, 0, 0}, at(0)), Catch::Contains("no longer open"));
  CHECK_THAT(rejection(a, {name, 2, 0, 0}, at(0)), Catch::Contains("not one of the choices"));
  CHECK_THAT(rejection(a, {name, -1, 0, 0}, at(0)), Catch::Contains("not one of the choices"));
  CHECK_THAT(rejection(a, {name, 0, 0.5, 0}, at(0)), Catch::Contains("range of its slider"));
  CHECK_THAT(rejection(a, {name, 0, 0, 0}, at(2.1)), Catch::Contains("no longer open"));
  CHECK_FALSE(a.take_answer());
  CHECK(rejection(a, {name, 0, 0, 0}, at(1)).empty());
  CHECK_THAT(rejection(a, {name, 1, 0, 0}, at(1)), Catch::Contains("has been answered"));
  CHECK(a.take_answer()->choice == 0);

  a.push(question(question_t::NUMBER, 1, 12), at(2));
  const std::string number = a.to_json(at(2))["question"];
  CHECK_FALSE(rejection(a, {number, -1, 1.01, 0}, at(2)).empty());
  CHECK_FALSE(rejection(a, {number, 0, 0.5, 0}, at(2)).empty());
  CHECK(rejection(a, {number, -1, -1, 0}, at(2)).empty());
  CHECK(a.take_answer()->number == -1);

  a.push(question(question_t::NOTHING, 2, 13), at(3));
  CHECK_FALSE(rejection(a, {a.to_json(at(3))["question"], -1, 0, 0}, at(3)).empty());
}

TEST_CASE("A page shows the trial runner and its end, and ignores questions of another run, except in a log") {
  Answers a(7), log(0);
  a.push(question(question_t::READ, 0, 3, 8), at(0));
  log.push(question(question_t::READ, 0, 3, 8), at(0));
  CHECK(a.to_json(at(0)).is_null());
  CHECK_FALSE(a.leader(at(0)));
  CHECK(log.to_json(at(0))["kind"] == "read");
  a.push(question(question_t::NOTHING), at(0));
  CHECK(a.to_json(at(0))["kind"] == "nothing");
  CHECK(a.leader(at(0)) == static_cast<std::int32_t>(sync::fnv1a_32("conductor")));
  CHECK(a.to_json(at(2.1)).is_null());
  log.clear();
  CHECK(log.to_json(at(0)).is_null());
}
