// Tests of parsing the requests of a study.
#include "scripts/trial_runner/requests.h"

#include <catch2/catch.hpp>
#include <tactus/question_t.hpp>
#include <tactus/sim_command_t.hpp>

using namespace tactus;
using namespace tactus::trial_runner;
using Catch::Contains;

TEST_CASE("Each kind of request is parsed") {
  CHECK(std::get<ProfileRequest>(parse_request(R"({"profile": "<profile/>"})")).text == "<profile/>");
  CHECK(std::get<TapRequest>(parse_request(R"({"tap": {"depth_m": 0.01}})")).depth_m == 0.01);
  CHECK(std::get<PressRequest>(parse_request(R"({"press": {"depth_m": 0.01, "period_s": 0.5, "times": 3}})")).times ==
        3);
  CHECK(std::get<CommandRequest>(parse_request(R"({"command": {"kind": "reset"}})")).kind == sim_command_t::RESET);
  CHECK(std::get<AnswerRequest>(parse_request(R"({"answer": {"number": 0.5}})")).number == 0.5);
  CHECK(std::holds_alternative<EndRequest>(parse_request(R"({"end": true})")));
  const auto q =
      std::get<QuestionRequest>(
          parse_request(
              R"({"question": {"kind": "number", "text": "How hard?", "lowest": 0, "highest": 1, "step": 0.1, "trial": 3, "condition": "c", "hint": "Pfeile"}})"))
          .question;
  CHECK(q.hint == "Pfeile");
  CHECK(q.kind == question_t::NUMBER);
  CHECK(q.trial == 3);
  CHECK(q.step == 0.1);
}

TEST_CASE("A malformed request is rejected with a reason") {
  const auto refuses = [](const char* line, const char* why) {
    CHECK_THROWS_WITH(parse_request(line), Contains(why));
  };
  refuses("", "JSON object with one member");
  refuses("[]", "JSON object with one member");
  refuses("{}", "JSON object with one member");
  refuses(R"({"end": true, "tap": {}})", "JSON object with one member");
  refuses(R"({"dance": 1})", "there is no request");
  refuses(R"({"tap": 1})", "tap is not a JSON object");
  refuses(R"({"tap": {"depth_m": "deep"}})", "depth_m is not a number from 0");
  refuses(R"({"tap": {"depth_m": 5}})", "depth_m is not a number from 0");
  refuses(R"({"question": {"kind": "riddle"}})", "not one of nothing, read, choice, number");
  refuses(R"({"question": {"kind": "choice", "choices": [1]}})", "a choice is not text");
  refuses(R"({"command": {"kind": "explode"}})", "not one of pause");
  refuses(R"({"profile": 3})", "profile is not text");
}
