// The requested chunks of one asset, as few ranges of bounded number, so that no request costs more than another. Pure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>

namespace tactus::sync {

class ChunkRanges {
 public:
  // With more gaps the smallest one is requested too. Design: a receiver requests at most 16 ranges at a time.
  static constexpr std::size_t kMaxRanges = 64;

  // Adds the chunks first .. end - 1. Cost: at most kMaxRanges.
  void add(std::size_t first, std::size_t end) {
    if (first >= end) return;
    auto at = ranges_.upper_bound(first);
    if (at != ranges_.begin() && std::prev(at)->second >= first) --at;
    while (at != ranges_.end() && at->first <= end) {
      first = std::min(first, at->first);
      end = std::max(end, at->second);
      at = ranges_.erase(at);
    }
    ranges_.emplace_hint(at, first, end);
    while (ranges_.size() > kMaxRanges) close_smallest_gap();
  }

  // Removes the next chunk after the one that was removed last, beginning again after the last one; none: no chunk is
  // requested. So no chunk waits for ever while others are requested again and again.
  std::optional<std::size_t> take() {
    if (ranges_.empty()) return std::nullopt;
    auto at = ranges_.upper_bound(next_);
    if (at != ranges_.begin() && std::prev(at)->second > next_) --at;
    if (at == ranges_.end()) at = ranges_.begin();
    const auto [first, end] = *at;
    const std::size_t taken = next_ >= first && next_ < end ? next_ : first;
    ranges_.erase(at);
    if (first < taken) ranges_.emplace(first, taken);
    if (taken + 1 < end) ranges_.emplace(taken + 1, end);
    next_ = taken + 1;
    return taken;
  }

  bool empty() const { return ranges_.empty(); }
  // Number of ranges: at most kMaxRanges after add(); take() may divide one.
  std::size_t ranges() const { return ranges_.size(); }

 private:
  void close_smallest_gap() {
    auto best = ranges_.begin();
    const auto gap_after = [](auto range) { return std::next(range)->first - range->second; };
    for (auto at = ranges_.begin(); std::next(at) != ranges_.end(); ++at)
      if (gap_after(at) < gap_after(best)) best = at;
    const auto next = std::next(best);
    best->second = next->second;
    ranges_.erase(next);
  }

  std::map<std::size_t, std::size_t> ranges_;  // first chunk: chunk after the last one; apart from each other
  std::size_t next_ = 0;
};

}  // namespace tactus::sync
