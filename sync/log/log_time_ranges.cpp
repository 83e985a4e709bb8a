#include "sync/log/log_time_ranges.h"

#include <algorithm>
#include <iterator>
#include <vector>

namespace tactus::sync {

void LogTimeRanges::add(std::int64_t t) {
  auto next = ranges_.upper_bound(t);
  auto at = next == ranges_.begin() ? ranges_.end() : std::prev(next);
  if (at != ranges_.end() && t <= at->second.last_us + kMaxGap_us) {
    at->second.last_us = std::max(at->second.last_us, t);
    ++at->second.events;
  } else if (next != ranges_.end() && next->first <= t + kMaxGap_us) {
    const Range range{next->second.last_us, next->second.events + 1};
    at = ranges_.insert_or_assign(ranges_.erase(next), t, range);
  } else {
    at = ranges_.insert_or_assign(next, t, Range{t, 1});
  }
  next = std::next(at);
  if (next != ranges_.end() && next->first <= at->second.last_us + kMaxGap_us) {
    at->second.last_us = std::max(at->second.last_us, next->second.last_us);
    at->second.events += next->second.events;
    ranges_.erase(next);
  }
  max_events_ = std::max(max_events_, at->second.events);
  if (ranges_.size() > kMax) remove_small_ranges();
}

void LogTimeRanges::remove_small_ranges() {
  std::vector<std::int64_t> counts;
  for (const auto& [first, range] : ranges_) counts.push_back(range.events);
  const auto middle = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2);
  std::nth_element(counts.begin(), middle, counts.end());
  const std::int64_t max_removed_events = std::min(*middle, kMinRunEvents - 1);
  std::size_t to_remove = ranges_.size() / 2;
  std::erase_if(ranges_, [&](const auto& entry) {
    const std::int64_t events = entry.second.events;
    if (to_remove == 0 || events > max_removed_events || events == max_events_) return false;
    removed_ += events;
    --to_remove;
    return true;
  });
}

bool LogTimeRanges::in_run(std::int64_t t) const {
  const auto next = ranges_.upper_bound(t);
  if (next == ranges_.begin()) return false;
  const Range& range = std::prev(next)->second;
  return t <= range.last_us && belongs_to_run(range);
}

std::int64_t LogTimeRanges::misdated() const {
  std::int64_t events = removed_;
  for (const auto& [first, range] : ranges_)
    if (!belongs_to_run(range)) events += range.events;
  return events;
}

}  // namespace tactus::sync
