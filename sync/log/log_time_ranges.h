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
  static constexpr std::int64_t kFewestOfARun = 32;
  // Stamps that are farther apart than this, with none between, belong to two ranges: SummaryClock::kLargestStep.
  static constexpr std::int64_t kApart_us = 60'000'000;
  // Limits the memory for a log with only random stamps. With more ranges, the half with the fewest events is removed.
  static constexpr std::size_t kMax = 65'536;

  // In any order; each call takes the logarithm of the number of ranges.
  void note(std::int64_t stamp_us);
  // True for a stamp in a range with as many events as a run has, or in the range with the most events.
  bool of_the_run(std::int64_t stamp_us) const;
  // Number of events for which of_the_run is false.
  std::int64_t misdated() const;

 private:
  struct Age {
    std::int64_t last_us;
    std::int64_t events;
  };
  void forget();
  bool good(const Age& age) const { return age.events >= kFewestOfARun || age.events == fullest_; }

  std::map<std::int64_t, Age> ages_;  // by their first stamp; ranges do not overlap
  std::int64_t fullest_ = 0;
  std::int64_t forgotten_ = 0;
};

}  // namespace tactus::sync
