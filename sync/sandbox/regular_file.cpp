#include "sync/sandbox/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <utility>

namespace tactus::sync {
namespace {

std::string limit_text(std::uintmax_t bytes) {
  return bytes >= 1 << 20 ? std::to_string(bytes >> 20) + " MiB" : std::to_string(bytes >> 10) + " KiB";
}

// A file whose name the system cannot look up does not exist for this process.
[[noreturn]] void throw_errno() {
  const bool missing = errno == ENOENT || errno == ENOTDIR || errno == ENAMETOOLONG || errno == ELOOP;
  throw std::runtime_error(missing ? "it does not exist" : "it is not readable");
}

void check(const struct stat& status, std::uintmax_t max_bytes) {
  if (!S_ISREG(status.st_mode)) throw std::runtime_error("it is not a regular file");
  if (static_cast<std::uintmax_t>(status.st_size) > max_bytes)
    throw std::runtime_error("it is larger than " + limit_text(max_bytes));
}

}  // namespace

RegularFile::RegularFile(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  // The system would end the name at the zero, and read another file than the one that was checked.
  if (file.native().find('\0') != std::string::npos) throw std::runtime_error("it does not exist");
  struct stat status {};
  // Opening some devices has an effect, for example on a tape or a watchdog, so the kind is checked first.
  if (stat(file.c_str(), &status) != 0) throw_errno();
  check(status, max_bytes);
  descriptor_ = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor_ < 0) throw_errno();
  try {
    if (fstat(descriptor_, &status) != 0) throw_errno();
    check(status, max_bytes);
  } catch (...) {
    close(descriptor_);
    throw;
  }
  size_bytes_ = static_cast<std::size_t>(status.st_size);
}

RegularFile::~RegularFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

int RegularFile::release() { return std::exchange(descriptor_, -1); }

void RegularFile::read(void* into) const {
  auto* to = static_cast<char*>(into);
  for (std::size_t at = 0; at < size_bytes_;) {
    const ssize_t got = pread(descriptor_, to + at, size_bytes_ - at, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw std::runtime_error("it is not readable");
    if (got == 0) throw std::runtime_error("it was shortened while it was read");
    at += static_cast<std::size_t>(got);
  }
}

void check_regular_file(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  RegularFile(file, max_bytes);
}

std::vector<std::uint8_t> read_regular_file(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  const RegularFile open_file(file, max_bytes);
  std::vector<std::uint8_t> bytes(open_file.size_bytes());
  open_file.read(bytes.data());
  return bytes;
}

std::string read_regular_text(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  const RegularFile open_file(file, max_bytes);
  std::string text(open_file.size_bytes(), '\0');
  open_file.read(text.data());
  return text;
}

}  // namespace tactus::sync
