// Reads files with an untrusted path: it may be a pipe, a device, or larger than memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::sync {

// An open regular file. Opening never waits: a pipe or a device is rejected before it is opened, and a file that is
// replaced by one in between is rejected after it.
class RegularFile {
 public:
  // max_bytes: largest accepted size. Throws std::runtime_error with one clause: "it does not exist", "it is not a
  // regular file", "it is not readable" or "it is larger than N MiB".
  RegularFile(const std::filesystem::path& file, std::uintmax_t max_bytes);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  // The size when it was opened.
  std::size_t size_bytes() const { return size_bytes_; }
  // Gives the open descriptor to the caller, who closes it.
  int release();
  // Reads the whole file. Throws std::runtime_error with one clause when the file is shorter than size_bytes() now.
  void read(void* into) const;

 private:
  int descriptor_ = -1;
  std::size_t size_bytes_ = 0;
};

// Throws std::runtime_error with one clause unless it is a readable regular file of at most max_bytes.
void check_regular_file(const std::filesystem::path& file, std::uintmax_t max_bytes);

// Checks the file in the same way, and returns its bytes.
std::vector<std::uint8_t> read_regular_file(const std::filesystem::path& file, std::uintmax_t max_bytes);
std::string read_regular_text(const std::filesystem::path& file, std::uintmax_t max_bytes);

}  // namespace tactus::sync
