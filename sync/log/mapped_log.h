// The bytes of a log: of one file, or of all parts of a recording, one behind the other.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace tactus::sync {

// Mapped, so that a log of any length takes no memory of its own. Each part begins at a multiple of
// kLogPartBytes (sync/log/log_reader.h), and what lies between is 0. Whoever cuts a file short meanwhile ends this
// process, with one sentence on stderr and status 1.
class MappedLog {
 public:
  // path: a file, or a folder that a recorder wrote to. Throws std::runtime_error with one sentence.
  explicit MappedLog(const std::string& path);
  ~MappedLog();
  MappedLog(const MappedLog&) = delete;
  MappedLog& operator=(const MappedLog&) = delete;
  std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace tactus::sync
