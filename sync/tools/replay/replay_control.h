// The commands of a user or a script to a running replay, one a line. Pure.
//
//   pause | resume | toggle | step [SECONDS] | seek [+|-]SECONDS | speed FACTOR|max | loop on|off | quit
#pragma once

#include <deque>
#include <string>
#include <string_view>

#include "sync/tools/replay/replay.h"

namespace tactus::sync {

// Default length of a step: a picture at 60 Hz.
inline constexpr double kStep_s = 1.0 / 60;

// Carries out one line. Returns an error sentence; empty: no error. Sets quit on that command.
std::string execute_command(Replay& replay, std::string_view line, HostTime now, bool& quit);

// "1.5" or "max", which is 0. Negative: invalid.
double speed_of(std::string_view word);

// Splits the bytes from a pipe into lines. A line longer than this is ignored.
class Lines {
 public:
  static constexpr std::size_t kMaxLine = 200;
  void add(std::string_view bytes) {
    for (const char c : bytes) {
      if (c != '\n') {
        if (line_.size() <= kMaxLine) line_ += c;
      } else {
        if (line_.size() <= kMaxLine && ready_.size() < kMax) ready_.push_back(line_);
        line_.clear();
      }
    }
  }
  // The oldest line; false: there is none.
  bool take(std::string& line) {
    if (ready_.empty()) return false;
    line = std::move(ready_.front());
    ready_.pop_front();
    return true;
  }

 private:
  static constexpr std::size_t kMax = 1000;
  std::string line_;
  std::deque<std::string> ready_;
};

}  // namespace tactus::sync
