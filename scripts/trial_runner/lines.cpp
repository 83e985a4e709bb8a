#include "scripts/trial_runner/lines.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>

namespace tactus::trial_runner {
namespace {

void set_nonblocking(int descriptor) { fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) | O_NONBLOCK); }

}  // namespace

Lines::Lines(int in, int out) : input_fd_(in), output_fd_(out) {
  std::signal(SIGPIPE, SIG_IGN);
  set_nonblocking(in);
  set_nonblocking(out);
}

std::optional<std::string> Lines::next() {
  char bytes[4096];
  for (ssize_t n; !ended_ && in_.size() <= kMaxLine; in_.append(bytes, static_cast<std::size_t>(n))) {
    n = read(input_fd_, bytes, sizeof bytes);
    if (n < 0) break;
    if (n == 0) ended_ = true;
  }
  const auto end = in_.find('\n');
  if (end == std::string::npos) {
    if (in_.size() > kMaxLine)
      throw std::runtime_error("a request is longer than 128 KiB; give one JSON object per line");
    return std::nullopt;
  }
  std::string line = in_.substr(0, end);
  in_.erase(0, end + 1);
  return line;
}

void Lines::write_line(const std::string& line) {
  if (out_.size() > kMaxUnread)
    throw std::runtime_error("more than 8 MiB of output are unread; read the output of trial_runner continuously");
  out_ += line;
  out_ += '\n';
  flush();
}

void Lines::flush() {
  while (!out_.empty()) {
    const ssize_t n = write(output_fd_, out_.data(), out_.size());
    if (n < 0 && errno == EPIPE) throw std::runtime_error("the reader of trial_runner's output has closed it");
    if (n <= 0) return;
    out_.erase(0, static_cast<std::size_t>(n));
  }
}

}  // namespace tactus::trial_runner
