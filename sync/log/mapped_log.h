// The bytes of a log: of one file, or of all parts of a recording, one after the other.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tactus::sync {

// Memory-mapped, so that a log of any length takes no memory of its own. Each part begins at a multiple of kLogPartBytes
// (sync/log/log_reader.h); the bytes in between are 0. When another process truncates a file meanwhile, this process ends
// with one sentence on stderr and status 1.
// kCurrent: a log of an earlier form of the messages is refused. kAny: it is accepted.
enum class LogTypes : std::uint8_t { kCurrent, kAny };

class MappedLog {
 public:
  // path: a file, or a folder that a recorder wrote to. Throws std::runtime_error with one sentence.
  explicit MappedLog(const std::string& path, LogTypes types = LogTypes::kCurrent);
  // Several logs, one behind the other.
  explicit MappedLog(const std::vector<std::string>& paths, LogTypes types = LogTypes::kCurrent);
  ~MappedLog();
  MappedLog(const MappedLog&) = delete;
  MappedLog& operator=(const MappedLog&) = delete;
  std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace tactus::sync
