#include "sync/text/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace tactus::sync {
namespace {

constexpr std::size_t kWaiting = 1 << 16;  // design: bytes per system call

}  // namespace

std::string part_of(const std::string& path) {
  std::error_code ignored;
  const bool plain = !std::filesystem::exists(path, ignored) || std::filesystem::is_regular_file(path, ignored);
  return plain ? path + ".part" : path;
}

AtomicFile::AtomicFile(std::string path, std::string option)
    : path_(std::move(path)), part_(part_of(path_)), option_(std::move(option)) {
  file_ = open(part_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0)
    throw std::runtime_error("cannot write " + path_ + " (" + std::strerror(errno) + "); choose another " +
                             option_);
  if (part_ == path_) return;
  // The second of two writers of one file is refused; the lock ends with the process.
  if (flock(file_, LOCK_EX | LOCK_NB) != 0 || ftruncate(file_, 0) != 0) {
    close(std::exchange(file_, -1));
    throw std::runtime_error("another program is writing " + part_ + "; choose another " + option_);
  }
}

AtomicFile::~AtomicFile() {
  if (file_ < 0) return;
  if (part_ != path_) unlink(part_.c_str());
  close(file_);
}

void AtomicFile::write(std::string_view text) {
  buffer_.append(text);
  if (buffer_.size() >= kWaiting) flush();
}

void AtomicFile::flush() {
  for (std::size_t done = 0; done < buffer_.size();) {
    const ssize_t n = ::write(file_, buffer_.data() + done, buffer_.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0)
      throw std::runtime_error("cannot continue to write " + path_ + " (" + std::strerror(n < 0 ? errno : ENOSPC) +
                               "); free disk space or choose another " + option_);
    done += static_cast<std::size_t>(n);
  }
  buffer_.clear();
}

void AtomicFile::finish() {
  if (file_ < 0) return;
  flush();
  std::error_code error;
  if (part_ != path_) std::filesystem::rename(part_, path_, error);
  if (error)
    throw std::runtime_error("cannot finish " + path_ + " (" + error.message() + "); choose another " + option_);
  close(std::exchange(file_, -1));
}

}  // namespace tactus::sync
