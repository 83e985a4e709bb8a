// The run of a log, the clock of its stamps, and their conversion to CLOCK_MONOTONIC. LOG_INFO contains them; where it is
// missing or damaged, they are recovered from the headers of the other messages. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tactus/log_info_t.hpp>
#include <utility>
#include <vector>

#include "sync/log/log_reader.h"
#include "sync/time/time.h"

namespace tactus::sync {

struct LogOrigin {
  // Without LOG_INFO only header.run_id, header.clock and realtime_offset_ns are set.
  log_info_t info{};
  bool known = false;     // false: the log contains no message of this system
  std::string recovered;  // one sentence; empty: LOG_INFO was complete

  // Converts a stamp to CLOCK_MONOTONIC of the recorder.
  HostTime time(std::int64_t timestamp_us) const;
};

// Clamps a stamp to a range that is safe for arithmetic in ns: within about 127 years of 1970.
std::int64_t bounded_us(std::int64_t timestamp_us);
// Converts a stamp to the recorder's CLOCK_MONOTONIC (lcmtypes/types/status/log_info_t.lcm); within the same bounds.
HostTime time_of_stamp(std::int64_t timestamp_us, std::int64_t realtime_offset_ns);

class LogClockDetector {
 public:
  // Maximum number of (run, clock) pairs: a cluster has few hosts, but damage creates false pairs.
  static constexpr std::size_t kMaxPairs = 64;
  // Events of each pair that its offset is estimated from.
  static constexpr std::size_t kMaxSamples = 4096;
  // LOG_INFO counts as damaged when stamps converted by it differ by more than this from the senders' times.
  static constexpr std::int64_t kContradiction_ns = 1'000'000'000;
  // Minimum number of the recorder's own messages for a run and clock; fewer may be noise.
  static constexpr std::int64_t kMinRecorderMessages = 8;

  void observe(const LogEvent& event);
  LogOrigin find() const;
  // Number of messages that name their run.
  std::int64_t messages_with_run() const;

 private:
  struct Pair {
    std::int64_t events = 0;
    std::int64_t of_recorder = 0;
    std::vector<std::int64_t> differences_ns;  // stamp minus publish_time_ns: the offset plus a latency
  };
  using Pairs = std::map<std::pair<std::int64_t, std::int32_t>, Pair>;
  Pairs::const_iterator likeliest_pair() const;
  // The 5 % quantile of the differences: near the smallest, and robust against damaged stamps.
  static std::int64_t offset_ns(const Pair& pair);

  std::optional<log_info_t> log_info_;
  Pairs pairs_;
};

}  // namespace tactus::sync
