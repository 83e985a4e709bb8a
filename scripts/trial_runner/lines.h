// Lines in and out of this process, never waited for: who reads slowly loses nothing up to a bound, and then this
// process ends with a word rather than hold up its hand.
#pragma once

#include <deque>
#include <optional>
#include <string>

namespace tactus::conductor {

class Lines {
 public:
  static constexpr std::size_t kMaxUnread = 8 << 20, kLongestLine = 1 << 17;  // bytes, design

  // Makes both descriptors non-blocking.
  Lines(int in, int out);

  // The next whole line that has come; nothing: there is none yet. Throws std::runtime_error for one that never
  // ends.
  std::optional<std::string> next();
  // True when whoever gave the orders has gone.
  bool ended() const { return ended_ && in_.find('\n') == std::string::npos; }
  // Throws std::runtime_error when nobody reads any more.
  void say(const std::string& line);
  // Writes what can be written now.
  void flush();

 private:
  int from_, to_;
  bool ended_ = false;
  std::string in_, out_;
};

}  // namespace tactus::conductor
