#include "sync/tools/replay/replay_control.h"

#include <optional>

#include "sync/text/csv.h"
#include "sync/text/printable.h"

namespace tactus::sync {
namespace {

std::optional<double> number(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  return csv_number(word);
}

std::string_view next_word(std::string_view& line) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!line.empty() && blank(line.front())) line.remove_prefix(1);
  std::size_t end = 0;
  while (end < line.size() && !blank(line[end])) ++end;
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

}  // namespace

double speed_of(std::string_view word) {
  if (word == "max") return 0;
  const auto value = number(word);
  return value && *value >= Replay::kMinSpeed && *value <= Replay::kMaxSpeed ? *value : -1;
}

std::string execute_command(Replay& replay, std::string_view line, HostTime now, bool& quit) {
  const std::string whole = printable(std::string(line));
  const std::string_view word = next_word(line), argument = next_word(line), rest = next_word(line);
  const auto wrong = [&](const char* remedy) { return "cannot execute '" + whole + "': " + remedy; };
  if (word.empty()) return "";
  if (!rest.empty()) return wrong("a command has at most one argument");
  const auto value = number(argument);
  if (word == "seek") {
    if (!value) return wrong("write it as seek SECONDS, or seek +SECONDS or seek -SECONDS from where it is");
    const bool relative = argument.front() == '+' || argument.front() == '-';
    replay.seek(relative ? replay.position_s() + *value : *value, now);
  } else if (word == "speed") {
    const double speed = speed_of(argument);
    if (speed < 0 || !replay.set_speed(speed, now)) return wrong("give a speed from 0.01 to 100, or max");
  } else if (word == "loop") {
    if (argument != "on" && argument != "off") return wrong("write it as loop on or loop off");
    replay.set_loop(argument == "on");
  } else if (word == "step") {
    if (!argument.empty() && (!value || *value < 0)) return wrong("write it as step or step SECONDS");
    replay.step(value.value_or(kStep_s), now);
  } else if (!argument.empty()) {
    return wrong(
        "it takes no argument, or is not a command; the commands are pause, resume, toggle, step, seek, speed, loop and quit");
  } else if (word == "pause") {
    replay.pause(now);
  } else if (word == "resume") {
    replay.resume(now);
  } else if (word == "toggle") {
    replay.paused() || replay.over() ? replay.resume(now) : replay.pause(now);
  } else if (word == "quit") {
    quit = true;
  } else {
    return wrong("there are pause, resume, toggle, step, seek, speed, loop and quit");
  }
  return "";
}

}  // namespace tactus::sync
