#include "sync/sandbox/reader_session.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "sync/sandbox/reader_child.h"

namespace tactus::sync {
namespace {

using Clock = std::chrono::steady_clock;

// Both ends of a connection without a name, which no other process can reach.
std::array<int, 2> connected() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw std::runtime_error(std::string("no connection to a reader: ") + std::strerror(errno));
  return ends;
}

// How a process failed during a request.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace

struct ReaderSession::Process {
  Process(const std::string& program, const std::vector<std::string>& arguments, std::array<int, 2> ends) try
      : socket(ends[0]), child(program, arguments, ends[1], ends[1]) {
    close(ends[1]);
  } catch (...) {
    close(ends[0]), close(ends[1]);
  }
  ~Process() { close(socket); }

  int socket;
  ReaderChild child;
};

ReaderSession::ReaderSession(std::string program, std::vector<std::string> arguments, const ReaderLimits& limits)
    : program_(std::move(program)), arguments_(std::move(arguments)), limits_(limits) {}

ReaderSession::~ReaderSession() = default;

std::vector<std::uint8_t> ReaderSession::request(std::span<const std::uint8_t> content) {
  if (!process_) {
    if (failures_ >= kMaxFailures)
      throw std::runtime_error("it is left out, because " + std::to_string(failures_) + " files before it ended their reader");
    process_ = std::make_unique<Process>(program_, arguments_, connected());
    ++started_;
  }
  try {
    return exchange(content);
  } catch (const Failure&) {
    process_.reset();
    ++failures_;
    throw;
  }
}

std::vector<std::uint8_t> ReaderSession::exchange(std::span<const std::uint8_t> content) {
  const std::uint64_t size = content.size();
  std::vector<std::uint8_t> out(sizeof size), in, block(std::size_t{64} << 10);
  std::memcpy(out.data(), &size, sizeof size);
  out.insert(out.end(), content.begin(), content.end());
  std::vector<Record> records;
  const auto deadline = Clock::now() + limits_.timeout;
  std::size_t sent = 0;
  while (records.empty()) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd ready{process_->socket, static_cast<short>(POLLIN | (sent < out.size() ? POLLOUT : 0)), 0};
    if (left <= 0) throw Failure(kReaderTimeout);
    if (poll(&ready, 1, static_cast<int>(left)) < 0 && errno != EINTR) throw Failure(std::strerror(errno));
    if (ready.revents & POLLOUT) {
      const ssize_t n = ::send(process_->socket, out.data() + sent, out.size() - sent, MSG_DONTWAIT | MSG_NOSIGNAL);
      sent += n > 0 ? static_cast<std::size_t>(n) : 0;
    }
    if (!(ready.revents & (POLLIN | POLLHUP | POLLERR))) continue;
    const ssize_t n = recv(process_->socket, block.data(), block.size(), MSG_DONTWAIT);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (n <= 0) {
      const std::string why = process_->child.wait(limits_.grace);
      throw Failure(why.empty() ? kReaderEndedEarly : why);
    }
    in.insert(in.end(), block.begin(), block.begin() + n);
    if (in.size() > limits_.max_bytes) throw Failure(too_much_content(limits_.max_bytes));
    split_records(in, records);
  }
  // An answer before the whole request was read, a second answer, or a rest of one: no later answer would belong to its file.
  if (sent < out.size() || records.size() > 1 || !in.empty()) throw Failure("its reader returned another answer than one to its file");
  return content_of(std::move(records.front()));
}

}  // namespace tactus::sync
