// What a person or a script says to a running replay, a line each. Pure.
//
//   pause | resume | toggle | step [SECONDS] | seek [+|-]SECONDS | speed FACTOR|max | loop on|off | quit
#pragma once

#include <deque>
#include <string>
#include <string_view>

#include "sync/tools/replay/replay.h"

namespace tactus::sync {

// A picture at 60 Hz: what a step is that nobody gives a length.
inline constexpr double kStep_s = 1.0 / 60;

// Obeys one line. Returns what is wrong with it, in one sentence; empty: nothing. quit is set when it says so.
std::string obey(Replay& replay, std::string_view line, HostTime now, bool& quit);

// "1.5" or "max", which is 0. Negative: neither.
double speed_of(std::string_view word);

// Lines out of pieces of bytes as they come from a pipe. A line longer than this is nobody's order: it is left
// out.
class Lines {
 public:
  static constexpr std::size_t kLongest = 200;
  void add(std::string_view bytes) {
    for (const char c : bytes) {
      if (c != '\n') {
        if (line_.size() <= kLongest) line_ += c;
      } else {
        if (line_.size() <= kLongest && ready_.size() < kMax) ready_.push_back(line_);
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
