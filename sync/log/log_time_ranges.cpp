#include "sync/log/log_time_ranges.h"

#include <algorithm>
#include <iterator>
#include <vector>

namespace tactus::sync {

void LogTimeRanges::note(std::int64_t t) {
  auto next = ages_.upper_bound(t);
  auto at = next == ages_.begin() ? ages_.end() : std::prev(next);
  if (at != ages_.end() && t <= at->second.last_us + kApart_us) {
    at->second.last_us = std::max(at->second.last_us, t);
    ++at->second.events;
  } else if (next != ages_.end() && next->first <= t + kApart_us) {
    const Age age{next->second.last_us, next->second.events + 1};
    at = ages_.insert_or_assign(ages_.erase(next), t, age);
  } else {
    at = ages_.insert_or_assign(next, t, Age{t, 1});
  }
  next = std::next(at);
  if (next != ages_.end() && next->first <= at->second.last_us + kApart_us) {
    at->second.last_us = std::max(at->second.last_us, next->second.last_us);
    at->second.events += next->second.events;
    ages_.erase(next);
  }
  fullest_ = std::max(fullest_, at->second.events);
  if (ages_.size() > kMax) forget();
}

void LogTimeRanges::forget() {
  std::vector<std::int64_t> counts;
  for (const auto& [first, age] : ages_) counts.push_back(age.events);
  const auto middle = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2);
  std::nth_element(counts.begin(), middle, counts.end());
  const std::int64_t most = std::min(*middle, kFewestOfARun - 1);
  std::size_t spare = ages_.size() / 2;
  for (auto it = ages_.begin(); it != ages_.end() && spare > 0;) {
    if (it->second.events > most || it->second.events == fullest_) {
      ++it;
      continue;
    }
    forgotten_ += it->second.events;
    it = ages_.erase(it);
    --spare;
  }
}

bool LogTimeRanges::of_the_run(std::int64_t t) const {
  const auto next = ages_.upper_bound(t);
  if (next == ages_.begin()) return false;
  const Age& age = std::prev(next)->second;
  return t <= age.last_us && good(age);
}

std::int64_t LogTimeRanges::misdated() const {
  std::int64_t events = forgotten_;
  for (const auto& [first, age] : ages_)
    if (!good(age)) events += age.events;
  return events;
}

}  // namespace tactus::sync
