// The files of one recording: DIR/run.lcmlog, or the number behind those that are there, and when it is split
// run.2.lcmlog, run.3.lcmlog, ... Each begins with a head of its own, so that it replays alone.
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
  std::int64_t max_bytes =
      0;  // of all parts together; the oldest are removed, and of a log of one part what exceeds it is left out
  bool splits() const { return split_bytes > 0 || split_after > Nanoseconds(0); }
};

class LogParts {
 public:
  LogParts(std::string dir, const LogLimits& limits) : dir_(std::move(dir)), limits_(limits) {}

  // A new file, which overwrites nothing. Throws as FileSink does.
  std::unique_ptr<LogSink> open();
  const std::string& path() const { return parts_.back().path; }
  // Removes the oldest parts beyond the limits, never the one that is written; the size of that one is given.
  void prune(std::int64_t present_bytes);
  // Bytes of the parts that are kept, less the present one.
  std::int64_t bytes_before() const;
  std::int64_t removed() const { return removed_; }

 private:
  struct Part {
    std::string path;
    std::int64_t bytes = 0;
  };
  std::string dir_;
  LogLimits limits_;
  int next_ = 0;  // 0: not known yet
  std::deque<Part> parts_;
  std::int64_t removed_ = 0;
};

}  // namespace tactus::sync
