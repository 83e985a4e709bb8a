// Which run a log is of, whose clock its stamps were read from, and how to read them as CLOCK_MONOTONIC. LOG_INFO
// says so; where that is missing or damaged, it is recovered from the headers of the other messages. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tactus/log_info_t.hpp>
#include <utility>
#include <vector>

#include "sync/log/log_reader.h"
#include "sync/time/time.h"

namespace tactus::sync {

struct LogOrigin {
  // Of a log without LOG_INFO only header.run_id, header.clock and realtime_offset_ns are known.
  log_info_t info{};
  bool known = false;     // false: no message of ours is in the log
  std::string recovered;  // one sentence; empty: LOG_INFO has told all of it

  // CLOCK_MONOTONIC of the recorder.
  HostTime time(std::int64_t timestamp_us) const;
};

// A stamp that any arithmetic in ns can bear: within some 127 years of 1970.
std::int64_t bounded_us(std::int64_t timestamp_us);
// What a stamp is by the recorder's CLOCK_MONOTONIC (lcmtypes/types/status/log_info_t.lcm); within the same bounds.
HostTime time_of_stamp(std::int64_t timestamp_us, std::int64_t realtime_offset_ns);

// By the beginning of a log, without reading all of it.
LogOrigin origin_of(std::span<const std::uint8_t> log);

class LogClockDetector {
 public:
  // So many pairs of a run and a clock are told apart: a cluster has few hosts; damage makes up more.
  static constexpr std::size_t kMaxPairs = 64;
  // Events of each pair that its offset is estimated from.
  static constexpr std::size_t kMaxSamples = 4096;
  // LOG_INFO is damaged where stamps read by it contradict what the senders say by more than this.
  static constexpr std::int64_t kContradiction_ns = 1'000'000'000;
  // So many messages of the recorder itself name its run and its clock; fewer may be noise.
  static constexpr std::int64_t kFewestOfRecorder = 8;

  void observe(const LogEvent& event);
  LogOrigin find() const;
  // Messages that have said which run they are of.
  std::int64_t witnesses() const;

 private:
  struct Pair {
    std::int64_t events = 0;
    std::int64_t of_recorder = 0;
    std::vector<std::int64_t> differences_ns;  // stamp minus publish_time_ns: the offset and a latency
  };
  using Pairs = std::map<std::pair<std::int64_t, std::int32_t>, Pair>;
  Pairs::const_iterator likeliest() const;
  // The 5 % quantile of the differences: near the smallest, whatever single damaged stamps say.
  static std::int64_t offset_ns(const Pair& pair);

  std::optional<log_info_t> told_;
  Pairs pairs_;
};

}  // namespace tactus::sync
