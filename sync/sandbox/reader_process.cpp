#include "sync/sandbox/reader_process.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "sync/sandbox/reader_child.h"

namespace tactus::sync {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

ReaderOutput run_reader(const std::string& program, const std::vector<std::string>& arguments,
                        const ReaderLimits& limits) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error(std::string("no pipe to a reader: ") + std::strerror(errno));
  fcntl(ends[0], F_SETPIPE_SZ, 1 << 20);  // fewer switches between the two processes; a small pipe works too
  struct Pipe {
    int descriptor;
    ~Pipe() { close(descriptor); }
  } const pipe{ends[0]};
  std::optional<ReaderChild> child;
  try {
    child.emplace(program, arguments, -1, ends[1]);
  } catch (...) {
    close(ends[1]);
    throw;
  }
  close(ends[1]);
  ReaderOutput output;
  std::vector<std::uint8_t> bytes, block(std::size_t{64} << 10);
  std::size_t total = 0;
  const auto deadline = Clock::now() + limits.timeout;
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd readable{pipe.descriptor, POLLIN, 0};
    const int ready = left > 0 ? poll(&readable, 1, static_cast<int>(left)) : 0;
    if (ready < 0 && errno == EINTR) continue;
    const ssize_t got = ready > 0 ? read(pipe.descriptor, block.data(), block.size()) : -1;
    if (got < 0 && ready > 0 && errno == EINTR) continue;
    if (got == 0) break;
    total += got > 0 ? static_cast<std::size_t>(got) : 0;
    if (got < 0 || total > limits.max_bytes) {
      child->end();
      output.failure = got < 0 ? kReaderTimeout : too_much_content(limits.max_bytes);
      return output;
    }
    bytes.insert(bytes.end(), block.begin(), block.begin() + got);
    split_records(bytes, output.records);
  }
  output.failure = child->wait(limits.grace);
  if (output.failure.empty() && !bytes.empty()) output.failure = kReaderEndedEarly;
  return output;
}

std::string text_of(const Record& record) {
  std::string text(record.content.begin(), record.content.begin() + static_cast<std::ptrdiff_t>(
                                               std::min<std::size_t>(record.content.size(), 400)));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

std::vector<std::uint8_t> read_in_process(const std::string& program, const std::vector<std::string>& arguments,
                                          const ReaderLimits& limits) {
  ReaderOutput output = run_reader(program, arguments, limits);
  if (output.failure.empty() && output.records.size() != 1) output.failure = "its reader returned nothing";
  if (!output.failure.empty()) throw std::runtime_error(output.failure);
  return content_of(std::move(output.records.front()));
}

std::vector<std::uint8_t> content_of(Record record) {
  if (record.kind == 'R') return std::move(record.content);
  throw std::runtime_error(text_of(record));
}

std::string too_much_content(std::size_t max_bytes) {
  return "it has more than " + std::to_string(max_bytes >> 20) + " MiB of content: simplify it";
}

void split_records(std::vector<std::uint8_t>& bytes, std::vector<Record>& records) {
  std::size_t at = 0;
  while (bytes.size() - at >= kRecordHeaderBytes) {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data() + at + 1, sizeof size);
    if (size > bytes.size() - at - kRecordHeaderBytes) break;
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at + kRecordHeaderBytes);
    records.push_back({static_cast<char>(bytes[at]), {begin, begin + static_cast<std::ptrdiff_t>(size)}});
    at += kRecordHeaderBytes + static_cast<std::size_t>(size);
  }
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

}  // namespace tactus::sync
