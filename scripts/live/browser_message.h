// Parses the messages of a browser as untrusted input: each kind has its members, each member its range, and anything else is
// refused with one sentence. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tactus::live {

// Positions of the sliders of one modality; 0: no degradation. A value of the profile in force may lie beyond the range of its slider.
struct Sliders {
  double delay_ms = 0;  // a moved slider: 0 .. 2000
  double rate_Hz = 0;   // 0, or 0.1 .. 1000
  double loss = 0;      // share, 0 .. 1
  std::optional<double> deadband{};  // share, 0 .. 1; empty: as it is
  std::map<std::string, std::string> choices{};  // sync::operator_choices() by name; without a name: as it is
};

struct WatchRequest {
  std::vector<std::string> names;  // "CHANNEL:path" or "node.tag", at most kMaxWatched
};
struct Command {
  std::int8_t kind = 0;  // of sim_command_t: PAUSE, RESUME, STEP or RESET
  int steps = 0;
};
struct DegradeRequest {
  std::map<std::string, Sliders> senses;
  bool clear = false;  // also removes all other operators of the profile in force
};
struct HandTarget {
  double x = 0, y = 0;  // place in the picture, -1 .. 1 from left to right and from bottom to top
  double push_m = 0;    // away from the camera, -1 .. 1
  bool down = false;    // held: the first button of the device
};
struct LogPlay {
  bool play = false;
  double rate = 1;  // 0.1 .. 16
};
struct LogSeek {
  double to_s = 0;  // time since the beginning of the log
};
// The answer of a participant to a study's question; answers.h checks it against the question.
struct PageAnswer {
  std::string question;       // its name, as sent to the page
  int choice = -1;            // 0 .. 8; -1: not a choice
  double number = 0;          // at most 1e9
  std::int64_t after_ns = 0;  // since the page first showed the question, at most a day
};
using BrowserMessage = std::variant<WatchRequest, Command, DegradeRequest, HandTarget, LogPlay, LogSeek, PageAnswer>;

inline constexpr std::size_t kMaxWatched = 32;
inline constexpr std::size_t kMaxBrowserBytes = 8192;

// Throws std::invalid_argument with one sentence.
BrowserMessage parse_browser_message(std::string_view text);

}  // namespace tactus::live
