// Requests to the trial runner, one JSON object with one member per line. Pure.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <tactus/question_t.hpp>
#include <variant>

namespace tactus::trial_runner {

// {"profile": "<profile .../>"}: puts it in force, and reports when every modality has it.
struct ProfileRequest {
  std::string text;
};
// {"question": {"kind": "read" | "choice" | "number" | "nothing", "text": , "choices": [], "lowest": , "highest": , "step": ,
// "trial": , "condition": , "progress": , "hint": }}: repeats it until it is answered. "nothing": a trial is in progress.
struct QuestionRequest {
  question_t question;
};
// {"answer": {"choice": 0}} or {"answer": {"number": 0.5}}: a simulated participant's answer to the current question.
struct AnswerRequest {
  int choice = -1;
  double number = 0;
};
// {"tap": {"depth_m": 0.012}}: the hand taps the surface below it. Needs --hand.
struct TapRequest {
  double depth_m = 0;
};
// {"press": {"depth_m": 0.012, "period_s": 1, "times": 2}}: the hand moves down and up this number of times, smoothly; the
// force on it is reported.
struct PressRequest {
  double depth_m = 0, period_s = 0;
  int times = 0;
};
// {"command": {"kind": "reset" | "pause" | "resume"}}, or "snapshot" and "restore" with a "name".
struct CommandRequest {
  std::int8_t kind = 0;
  std::string name;
};
// {"end": true}
struct EndRequest {};

using Request = std::variant<ProfileRequest, QuestionRequest, AnswerRequest, TapRequest, PressRequest, CommandRequest, EndRequest>;

// Throws std::invalid_argument with one sentence for any other line.
Request parse_request(std::string_view line);

}  // namespace tactus::trial_runner
