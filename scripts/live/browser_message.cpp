#include "scripts/live/browser_message.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <tactus/sim_command_t.hpp>

namespace tactus::live {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxModalities = 16;
constexpr int kMaxSteps = 10'000;
constexpr std::size_t kMaxChoices = 8, kMaxChoiceName = 32;

double number(const json& j, const char* name, double min, double max) {
  const auto found = j.find(name);
  if (found == j.end() || !found->is_number())
    throw std::invalid_argument(std::string("the page sent no number \"") + name + "\"; reload the page");
  const double value = found->get<double>();
  if (!(value >= min && value <= max))
    throw std::invalid_argument(std::string("\"") + name + "\" is out of range; reload the page");
  return value;
}

bool flag(const json& j, const char* name) {
  const auto found = j.find(name);
  if (found == j.end() || !found->is_boolean())
    throw std::invalid_argument(std::string("the page sent no flag \"") + name + "\"; reload the page");
  return found->get<bool>();
}

std::string text(const json& j, std::size_t max) {
  if (!j.is_string()) throw std::invalid_argument("the page sent a name that is not text; reload the page");
  std::string s = j.get<std::string>();
  const auto printable = [](unsigned char c) { return c > 32 && c < 127; };
  if (s.empty() || s.size() > max || !std::all_of(s.begin(), s.end(), printable))
    throw std::invalid_argument("the page sent a name that is empty, too long or not printable; reload the page");
  return s;
}

// A modality, or "MODALITY:STAGE".
bool is_modality_name(const std::string& name) {
  return std::count(name.begin(), name.end(), ':') <= 1 && name.front() != ':' && name.back() != ':' &&
         std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == ':';
  });
}

WatchRequest watch(const json& j) {
  const auto names = j.find("names");
  if (names == j.end() || !names->is_array() || names->size() > kMaxWatched)
    throw std::invalid_argument("the page watches at most " + std::to_string(kMaxWatched) + " variables; remove some");
  WatchRequest w;
  for (const json& name : *names) w.names.push_back(text(name, 192));
  return w;
}

Command command(const json& j) {
  const auto what = j.find("what");
  const std::string word = what == j.end() ? "" : text(*what, 16);
  if (word == "pause") return {sim_command_t::PAUSE, 0};
  if (word == "resume") return {sim_command_t::RESUME, 0};
  if (word == "reset") return {sim_command_t::RESET, 0};
  if (word == "step") return {sim_command_t::STEP, static_cast<int>(number(j, "steps", 1, kMaxSteps))};
  throw std::invalid_argument("the page sent an unknown command; reload the page");
}

// Lower-case words only; the profile refuses unknown ones.
std::map<std::string, std::string> chosen(const json& j) {
  if (!j.is_object() || j.size() > kMaxChoices)
    throw std::invalid_argument("the page sent no choices, or too many; reload the page");
  std::map<std::string, std::string> choices;
  for (const auto& [name, value] : j.items()) {
    const std::string of_value = text(value, kMaxChoiceName);
    const auto is_word = [](const std::string& word) {
      return !word.empty() && word.size() <= kMaxChoiceName && std::all_of(word.begin(), word.end(), [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
    };
    if (!is_word(name) || !is_word(of_value)) throw std::invalid_argument("the page sent a choice that is not a word; reload the page");
    choices[name] = of_value;
  }
  return choices;
}

// A page also sends the values of the profile in force, which may exceed its sliders; with_sliders() limits only those that differ.
constexpr double kMaxInForce = 1e9;

DegradeRequest degrade(const json& j) {
  const auto senses = j.find("senses");
  if (senses == j.end() || !senses->is_object() || senses->size() > kMaxModalities)
    throw std::invalid_argument("the page sent no sliders, or too many; reload the page");
  DegradeRequest d;
  d.clear = flag(j, "clear");
  for (const auto& [name, s] : senses->items()) {
    if (name.empty() || name.size() > 64 || !is_modality_name(name) || !s.is_object())
      throw std::invalid_argument("the page sent sliders of an invalid modality name; reload the page");
    Sliders sliders{number(s, "delay_ms", 0, kMaxInForce), number(s, "rate_Hz", 0, kMaxInForce), number(s, "loss", 0, 1)};
    if (s.contains("deadband")) sliders.deadband = number(s, "deadband", 0, kMaxInForce);
    if (const auto choices = s.find("choices"); choices != s.end()) sliders.choices = chosen(*choices);
    d.senses[name] = sliders;
  }
  return d;
}

PageAnswer answer(const json& j) {
  constexpr double kMaxAnswerTime_ns = 86'400e9;
  const auto question = j.find("question");
  if (question == j.end()) throw std::invalid_argument("the page's answer names no question; reload the page");
  const double choice = number(j, "choice", -1, 8);
  if (choice != std::floor(choice)) throw std::invalid_argument("\"choice\" is not a whole number; reload the page");
  return {text(*question, 64), static_cast<int>(choice), number(j, "number", -1e9, 1e9),
          static_cast<std::int64_t>(number(j, "after_ns", 0, kMaxAnswerTime_ns))};
}

}  // namespace

BrowserMessage parse_browser_message(std::string_view bytes) {
  if (bytes.size() > kMaxBrowserBytes) throw std::invalid_argument("the page sent a message of more than 8192 bytes; reload the page");
  const json j = json::parse(bytes, nullptr, false);
  if (!j.is_object() || !j.contains("t")) throw std::invalid_argument("the page sent a malformed message; reload the page");
  const std::string kind = text(j["t"], 16);
  if (kind == "watch") return watch(j);
  if (kind == "command") return command(j);
  if (kind == "degrade") return degrade(j);
  if (kind == "hand") return HandTarget{number(j, "x", -1, 1), number(j, "y", -1, 1), number(j, "push_m", -1, 1), flag(j, "down")};
  if (kind == "play") return LogPlay{flag(j, "play"), number(j, "rate", 0.1, 16)};
  if (kind == "seek") return LogSeek{number(j, "to_s", 0, 1e7)};
  if (kind == "answer") return answer(j);
  throw std::invalid_argument("the page sent an unknown kind of message; reload the page");
}

}  // namespace tactus::live
