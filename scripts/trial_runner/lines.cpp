#include "scripts/trial_runner/lines.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>

namespace tactus::trial_runner {
namespace {

void never_wait(int descriptor) { fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) | O_NONBLOCK); }

}  // namespace

Lines::Lines(int in, int out) : from_(in), to_(out) {
  std::signal(SIGPIPE, SIG_IGN);
  never_wait(in);
  never_wait(out);
}

std::optional<std::string> Lines::next() {
  char bytes[4096];
  for (ssize_t n; !ended_ && in_.size() <= kLongestLine; in_.append(bytes, static_cast<std::size_t>(n))) {
    n = read(from_, bytes, sizeof bytes);
    if (n < 0) break;
    if (n == 0) ended_ = true;
  }
  const auto end = in_.find('\n');
  if (end == std::string::npos) {
    if (in_.size() > kLongestLine)
      throw std::runtime_error("an order is longer than 128 KiB; give one JSON object a line");
    return std::nullopt;
  }
  std::string line = in_.substr(0, end);
  in_.erase(0, end + 1);
  return line;
}

void Lines::say(const std::string& line) {
  if (out_.size() > kMaxUnread)
    throw std::runtime_error("nobody reads what the conductor says; read its lines as they come");
  out_ += line;
  out_ += '\n';
  flush();
}

void Lines::flush() {
  while (!out_.empty()) {
    const ssize_t n = write(to_, out_.data(), out_.size());
    if (n < 0 && errno == EPIPE) throw std::runtime_error("whoever listened to the conductor has gone");
    if (n <= 0) return;
    out_.erase(0, static_cast<std::size_t>(n));
  }
}

}  // namespace tactus::trial_runner
