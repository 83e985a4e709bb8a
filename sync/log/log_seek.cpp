#include "sync/log/log_seek.h"

#include <algorithm>
#include <vector>

#include "lcmtypes/channels.h"
#include "sync/log/log_time_ranges.h"
#include "sync/log/log_origin.h"
#include "sync/log/log_reader.h"
#include "sync/log/recorder_types.h"

namespace tactus::sync {
namespace {

// The median tolerates four damaged stamps of nine.
constexpr std::size_t kMedianStamps = 9;
// An interval of this size is read instead of bisected.
constexpr std::size_t kMaxIntervalBytes = 1 << 16;

// The head of a part is stamped earlier than the end of the previous part.
bool of_a_head(const LogEvent& e) {
  return e.channel == channels::kLogInfo || e.channel == kLogTypes || e.channel == channels::kSceneManifest ||
         e.channel == channels::kAssetChunk;
}

std::vector<std::int64_t> stamps_from(std::span<const std::uint8_t> log, std::size_t at, std::size_t max_stamps,
                                      bool with_heads = true) {
  LogScanner scanner(log);
  scanner.seek(at);
  std::vector<std::int64_t> stamps;
  for (LogEvent e; stamps.size() < max_stamps && scanner.next(e);)
    if (with_heads || !of_a_head(e)) stamps.push_back(bounded_us(e.timestamp_us));
  return stamps;
}

std::int64_t median(std::vector<std::int64_t> v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

}  // namespace

std::optional<std::int64_t> stamp_near(std::span<const std::uint8_t> log, std::size_t at) {
  const std::vector<std::int64_t> stamps = stamps_from(log, at, kMedianStamps, false);
  if (stamps.empty()) return std::nullopt;
  return median(stamps);
}

std::size_t seek_log(std::span<const std::uint8_t> log, std::int64_t timestamp_us) {
  std::size_t low = 0, high = log.size();
  while (high - low > kMaxIntervalBytes) {
    const std::size_t middle = low + (high - low) / 2;
    // The search is limited to the interval: a gap of many GB would otherwise be read for every probe in it.
    const auto stamp = stamp_near(log.first(high), middle);
    (!stamp || *stamp >= timestamp_us ? high : low) = middle;
  }
  return low;
}

std::optional<LogSpan> span_of_log(std::span<const std::uint8_t> log) {
  const std::vector<std::int64_t> head = stamps_from(log, 0, kMedianStamps);
  if (head.empty()) return std::nullopt;
  std::vector<std::int64_t> tail;
  for (std::size_t back = kMaxIntervalBytes; tail.empty(); back *= 8) {
    tail = stamps_from(log, log.size() - std::min(back, log.size()), SIZE_MAX);
    if (back >= log.size()) break;
  }
  if (tail.size() > kMedianStamps) tail.erase(tail.begin(), tail.end() - static_cast<std::ptrdiff_t>(kMedianStamps));
  // The extremes of the stamps near the median.
  const auto extreme = [](const std::vector<std::int64_t>& stamps, bool least) {
    const std::int64_t at = median(stamps);
    std::int64_t found = at;
    for (const std::int64_t t : stamps)
      if (std::abs(t - at) <= LogTimeRanges::kMaxGap_us) found = least ? std::min(found, t) : std::max(found, t);
    return found;
  };
  const std::int64_t first = extreme(head, true);
  return LogSpan{first, std::max(first, extreme(tail, false))};
}

}  // namespace tactus::sync
