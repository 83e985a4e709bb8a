#include "sync/sandbox/reader_program.h"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>

namespace tactus::sync {
namespace {

void write_all(const void* bytes, std::size_t count) {
  const auto* from = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t n = write(STDOUT_FILENO, from, count);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) _exit(1);  // no process waits for the result any more
    from += n;
    count -= static_cast<std::size_t>(n);
  }
}

void send(char kind, std::span<const std::uint8_t> content) {
  const std::uint64_t size = content.size();
  write_all(&kind, 1);
  write_all(&size, sizeof size);
  write_all(content.data(), content.size());
}

void send_error(const std::string& clause) {
  send('E', {reinterpret_cast<const std::uint8_t*>(clause.data()), clause.size()});
}

// False at the end of the input.
bool read_all(void* bytes, std::size_t count) {
  auto* to = static_cast<char*>(bytes);
  while (count > 0) {
    const ssize_t n = ::read(STDIN_FILENO, to, count);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    to += n;
    count -= static_cast<std::size_t>(n);
  }
  return true;
}

// Empty, or why this process must not parse anything.
std::string confine(const std::vector<std::filesystem::path>& readable, const SandboxLimits& limits) {
  const Confinement available = available_confinement();
  return missing_measure(confine_process(readable, limits), available);
}

// Runs `work`, which answers; an exception becomes the answer.
template <class Work>
void answer(const SandboxLimits& limits, Work&& work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    send_error("it needs more than " + std::to_string(limits.memory_bytes >> 20) +
               " MiB of memory to read: simplify it");
  } catch (const std::exception& e) {
    send_error(e.what());
  }
}

}  // namespace

std::optional<int> reader_options(int argc, char** argv, const std::string& help) {
  if (argc < 2 || argv[1][0] != '-') return std::nullopt;
  const std::string option = argv[1];
  if (option == "--help" || option == "-h") {
    std::cout << help;
    return 0;
  }
  std::cerr << std::filesystem::path(argv[0]).filename().string() << ": unknown option '" << option << "'; see --help\n";
  return 1;
}

int reader_main(const std::vector<std::filesystem::path>& readable, const SandboxLimits& limits,
                const std::function<void(const SendRecord&)>& read) {
  const std::string refused = confine(readable, limits);
  answer(limits, [&] {
    if (!refused.empty()) throw std::runtime_error(refused);
    read(send);
  });
  // Without destructors and without the checks of a sanitizer at exit, which need system calls.
  _exit(0);
}

int reader_session_main(const std::vector<std::filesystem::path>& readable, const SandboxLimits& limits,
                        const std::function<std::vector<std::uint8_t>(std::span<const std::uint8_t>)>& read) {
  const std::string refused = confine(readable, limits);
  for (std::uint64_t size = 0; read_all(&size, sizeof size);) {
    answer(limits, [&] {
      std::vector<std::uint8_t> request(size);
      if (!read_all(request.data(), request.size())) _exit(1);
      if (!refused.empty()) throw std::runtime_error(refused);
      send('R', read(request));
    });
  }
  _exit(0);
}

}  // namespace tactus::sync
