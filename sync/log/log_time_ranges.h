// Separates the stamps of a log's run from damaged ones: damaged stamps are scattered, while a run has many stamps near each
// other. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

namespace tactus::sync {

class LogTimeRanges {
 public:
  // Design: fewer than 32 nearby stamps cannot be a run, because every node publishes its health at 10 Hz.
  static constexpr std::int64_t kMinRunEvents = 32;
  // Stamps that are farther apart than this, with none between, belong to two ranges: SummaryClock::kMaxStep.
  static constexpr std::int64_t kMaxGap_us = 60'000'000;
  // Limits the memory for a log with only random stamps. With more ranges, the half with the fewest events is removed.
  static constexpr std::size_t kMax = 65'536;

  // In any order; each call takes the logarithm of the number of ranges.
  void add(std::int64_t stamp_us);
  // True for a stamp in a range with as many events as a run has, or in the range with the most events.
  bool in_run(std::int64_t stamp_us) const;
  // Number of events for which in_run is false.
  std::int64_t misdated() const;

 private:
  struct Range {
    std::int64_t last_us;
    std::int64_t events;
  };
  void remove_small_ranges();
  bool belongs_to_run(const Range& range) const { return range.events >= kMinRunEvents || range.events == max_events_; }

  std::map<std::int64_t, Range> ranges_;  // by their first stamp; ranges do not overlap
  std::int64_t max_events_ = 0;
  std::int64_t removed_ = 0;
};

}  // namespace tactus::sync
