// The files of one recording: DIR/run.lcmlog, or the number after the existing ones, and for a split recording run.2.lcmlog,
// run.3.lcmlog, ... Each begins with its own head, so that it replays alone.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "sync/log/log_writer.h"
#include "sync/time/time.h"

namespace tactus::sync {

// The parts in a folder, in the order of their numbers.
std::vector<std::string> log_parts_in(const std::string& dir);

// 0: no limit.
struct LogLimits {
  std::int64_t split_bytes = 0;
  Nanoseconds split_after{0};
  int keep = 0;  // parts; the oldest are removed
  // Maximum size of all parts together; the oldest parts are removed. A log of a single part leaves out the excess.
  std::int64_t max_bytes = 0;
  bool splits() const { return split_bytes > 0 || split_after > Nanoseconds(0); }
};

class LogParts {
 public:
  LogParts(std::string dir, const LogLimits& limits) : dir_(std::move(dir)), limits_(limits) {}

  // Opens a new file without overwriting any. Throws as FileSink does.
  std::unique_ptr<LogSink> open();
  const std::string& path() const { return parts_.back().path; }
  // Removes the oldest parts beyond the limits, but not the one being written, whose size is given.
  void prune(std::int64_t present_bytes);
  // Bytes of the kept parts, without the current one.
  std::int64_t bytes_before() const;

 private:
  struct Part {
    std::string path;
    std::int64_t bytes = 0;
  };
  std::string dir_;
  LogLimits limits_;
  int next_ = 0;  // 0: not determined yet
  std::deque<Part> parts_;
};

}  // namespace tactus::sync
