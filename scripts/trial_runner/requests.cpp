#include "scripts/trial_runner/requests.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <tactus/sim_command_t.hpp>

namespace tactus::trial_runner {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& sentence) { throw std::invalid_argument(sentence); }

std::string text_of(const json& j, const char* key) {
  const auto at = j.find(key);
  if (at == j.end()) return {};
  if (!at->is_string()) refuse(std::string(key) + " is not text");
  return at->get<std::string>();
}

double number_of(const json& j, const char* key, double least, double most) {
  const auto at = j.find(key);
  const double value = at != j.end() && at->is_number() ? at->get<double>() : NAN;
  if (!(value >= least && value <= most))
    refuse(std::string(key) + " is not a number from " + json(least).dump() + " to " + json(most).dump());
  return value;
}

std::int8_t choice_of(const json& j, const char* key,
                      std::initializer_list<std::pair<const char*, std::int8_t>> names) {
  const std::string word = text_of(j, key);
  std::string all;
  for (const auto& [name, value] : names) {
    if (word == name) return value;
    all += (all.empty() ? "" : ", ") + std::string(name);
  }
  refuse(std::string(key) + " \"" + word + "\" is not one of " + all);
}

Request question(const json& j) {
  question_t q{};
  q.kind = choice_of(j, "kind",
                     {{"nothing", question_t::NOTHING},
                      {"read", question_t::READ},
                      {"choice", question_t::CHOICE},
                      {"number", question_t::NUMBER}});
  q.text = text_of(j, "text"), q.condition = text_of(j, "condition"), q.progress = text_of(j, "progress");
  q.hint = text_of(j, "hint");
  if (j.contains("trial")) q.trial = static_cast<std::int32_t>(number_of(j, "trial", 0, 1e9));
  if (const auto at = j.find("choices"); at != j.end()) {
    if (!at->is_array()) refuse("choices is not a list");
    for (const json& c : *at) {
      if (!c.is_string()) refuse("a choice is not text");
      q.choices.push_back(c.get<std::string>());
    }
  }
  q.count = static_cast<std::int32_t>(q.choices.size());
  if (q.kind == question_t::NUMBER) {
    q.lowest = number_of(j, "lowest", -1e9, 1e9), q.highest = number_of(j, "highest", -1e9, 1e9);
    q.step = number_of(j, "step", 0, 1e9);
  }
  return QuestionRequest{q};
}

Request answer(const json& j) {
  AnswerRequest a;
  if (j.contains("choice")) a.choice = static_cast<int>(number_of(j, "choice", 0, 8));
  if (j.contains("number")) a.number = number_of(j, "number", -1e9, 1e9);
  return a;
}

Request command(const json& j) {
  CommandRequest c;
  c.kind = choice_of(j, "kind",
                     {{"pause", sim_command_t::PAUSE},
                      {"resume", sim_command_t::RESUME},
                      {"reset", sim_command_t::RESET},
                      {"snapshot", sim_command_t::SNAPSHOT},
                      {"restore", sim_command_t::RESTORE}});
  c.name = text_of(j, "name");
  return c;
}

Request press(const json& j) {
  return PressRequest{number_of(j, "depth_m", 0, 0.1), number_of(j, "period_s", 0.1, 10),
                    static_cast<int>(number_of(j, "times", 1, 100))};
}

}  // namespace

Request parse_request(std::string_view line) {
  const json j = json::parse(line, nullptr, false);
  if (!j.is_object() || j.size() != 1)
    refuse("a request is a JSON object with one member, for example {\"end\": true}");
  const std::string& what = j.begin().key();
  const json& value = j.begin().value();
  const auto object = [&]() -> const json& {
    if (!value.is_object()) refuse(what + " is not a JSON object");
    return value;
  };
  if (what == "profile") {
    if (!value.is_string()) refuse("profile is not text");
    return ProfileRequest{value.get<std::string>()};
  }
  if (what == "question") return question(object());
  if (what == "answer") return answer(object());
  if (what == "tap") return TapRequest{number_of(object(), "depth_m", 0, 0.1)};
  if (what == "press") return press(object());
  if (what == "command") return command(object());
  if (what == "end") return EndRequest{};
  refuse("there is no request \"" + what + "\"");
}

}  // namespace tactus::trial_runner
