// The events of a log in order, each with the time to pass it on: its own stamp, or where that is damaged the time of the
// previous event. Times decrease only where the log itself continues at an earlier time. Pure.
#pragma once

#include <optional>
#include <span>

#include "sync/log/log_time_ranges.h"
#include "sync/log/log_origin.h"
#include "sync/log/log_reader.h"
#include "sync/log/summary_clock.h"

namespace tactus::sync {

class TimestampedEvents {
 public:
  // time_ranges: the valid stamps of this log, if known; null: any. Both outlive this object.
  TimestampedEvents(std::span<const std::uint8_t> bytes, const LogOrigin& origin, const LogTimeRanges* time_ranges = nullptr)
      : scanner_(bytes), origin_(origin), time_ranges_(time_ranges) {}

  // Continues with the first event at or after this byte, as if no event had been read; no time is before `from`.
  void seek(std::size_t at, HostTime from);
  // False at the end.
  bool next(LogEvent& event, HostTime& time);

  const LogScanner& scanner() const { return scanner_; }

 private:
  bool plausible(const LogEvent& event) const {
    return time_ranges_ == nullptr || time_ranges_->in_run(bounded_us(event.timestamp_us));
  }
  HostTime time_of(const LogEvent& event);

  LogScanner scanner_;
  const LogOrigin& origin_;
  const LogTimeRanges* time_ranges_;
  SummaryClock clock_;
  std::optional<HostTime> before_;
  std::optional<LogEvent> lookahead_;
  bool started_ = false;
};

}  // namespace tactus::sync
