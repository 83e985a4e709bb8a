// The events of one run of a log, each once, in the order of their times, with the time to pass each on. Pure.
//
// The stamp of an event that it returns (LogEvent::timestamp_us) is the corrected one. Times never decrease.
#pragma once

#include <cstdint>
#include <optional>

#include "sync/log/log_index.h"
#include "sync/log/log_origin.h"
#include "sync/log/log_reader.h"
#include "sync/time/time.h"

namespace tactus::sync {

class TimestampedEvents {
 public:
  // Instead of the number of a run: every event of the file, with copies, in the order of the file, one run behind the other.
  static constexpr int kWholeFile = 0;

  // number: of the run, from 1. The index outlives this object; events that it has not read yet come when it has.
  TimestampedEvents(const LogIndex& index, int number);

  // Continues with the first event at this time or later, and a few before it: at most those of LogIndex::kSeekInterval_us.
  void seek(HostTime from);
  // False at the end, or where the index ends.
  bool next(LogEvent& event, HostTime& time);

  // Of the whole file; its times are on the clock of the first run.
  std::int64_t first_us() const;
  std::int64_t last_us() const;
  const LogOrigin& origin() const { return first_run().origin; }

 private:
  const RecordedRun& first_run() const { return index_->runs()[whole_file_ ? 0 : run_]; }
  const RecordedRun& run() const { return index_->runs()[run_]; }
  void enter(std::size_t run, std::int64_t join_us);
  bool enter_next_run();
  // Added to the stamps of the run behind this one, so that it follows it: the pause between them stays, a step back does not.
  std::int64_t join_behind(std::size_t run, std::int64_t join_us) const;
  bool read_ahead();
  const RecordedRun::LateEvent* next_late() const;

  const LogIndex* index_;
  bool whole_file_;
  std::size_t run_;
  std::int64_t join_us_ = 0;  // added to the stamps of the present run of the whole file
  LogScanner scanner_;
  std::int64_t event_ = 0;    // number of the next event in the log
  std::optional<LogEvent> ahead_;
  std::int64_t ahead_event_ = 0;  // number of ahead_
  std::int64_t newest_us_ = 0, returned_us_ = INT64_MIN;
  RecordedRun::LateEvent passed_late_{INT64_MIN, 0, 0};
};

}  // namespace tactus::sync
