// Which stamps of a log are of its run: damage makes stamps of any age, and a run has many near each other. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

namespace tactus::sync {

class LogTimeRanges {
 public:
  // Design: who takes part in a run says ten times a second how it is; so few near each other are no run.
  static constexpr std::int64_t kFewestOfARun = 32;
  // Stamps that are farther apart than this, with none between, are of two ages: SummaryClock::kLargestStep.
  static constexpr std::int64_t kApart_us = 60'000'000;
  // A log whose stamps are all noise takes no more memory than this. When there are more ages the emptiest half is
  // forgotten.
  static constexpr std::size_t kMax = 65'536;

  // In any order; each takes the logarithm of the number of ages.
  void note(std::int64_t stamp_us);
  // True of a stamp in an age of as many events as a run has, or in the fullest age of all.
  bool of_the_run(std::int64_t stamp_us) const;
  // Events that of_the_run denies.
  std::int64_t misdated() const;

 private:
  struct Age {
    std::int64_t last_us;
    std::int64_t events;
  };
  void forget();
  bool good(const Age& age) const { return age.events >= kFewestOfARun || age.events == fullest_; }

  std::map<std::int64_t, Age> ages_;  // by their first stamp; none touches another
  std::int64_t fullest_ = 0;
  std::int64_t forgotten_ = 0;
};

}  // namespace tactus::sync
