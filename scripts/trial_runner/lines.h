// Non-blocking line input and output of this process: unread output is buffered up to a bound; beyond it the process ends
// with an error, because waiting would stop its hand.
#pragma once

#include <optional>
#include <string>

namespace tactus::trial_runner {

class Lines {
 public:
  static constexpr std::size_t kMaxUnread = 8 << 20, kMaxLine = 1 << 17;  // bytes, design

  // Makes both descriptors non-blocking.
  Lines(int in, int out);

  // The next complete line; nullopt: there is none yet. Throws std::runtime_error for a line longer than kMaxLine.
  std::optional<std::string> next();
  // True when the sender of the commands has closed the input.
  bool ended() const { return ended_ && in_.find('\n') == std::string::npos; }
  // Throws std::runtime_error when the output is closed or too much is unread.
  void write_line(const std::string& line);
  // Writes as much as possible without waiting.
  void flush();

 private:
  int input_fd_, output_fd_;
  bool ended_ = false;
  std::string in_, out_;
};

}  // namespace tactus::trial_runner
