#include "sync/sandbox/reader_program.h"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <iostream>
#include <new>
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
  confine_process(readable, limits);
  try {
    read(send);
  } catch (const std::bad_alloc&) {
    send_error("it needs more than " + std::to_string(limits.memory_bytes >> 20) +
               " MiB of memory to read: simplify it");
  } catch (const std::exception& e) {
    send_error(e.what());
  }
  // Without destructors and without the checks of a sanitizer at exit, which need system calls.
  _exit(0);
}

}  // namespace tactus::sync
