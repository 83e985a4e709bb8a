#include "sync/log/log_origin.h"

#include <algorithm>

#include "lcmtypes/channels.h"
#include "lcmtypes/fields.h"
#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "sync/log/log_header.h"

namespace tactus::sync {
namespace {

constexpr std::int64_t kMaxStamp_ns = 4'000'000'000'000'000'000;  // the difference of two stamps still fits the type

}  // namespace

std::int64_t bounded_us(std::int64_t timestamp_us) {
  return std::clamp(timestamp_us, -kMaxStamp_ns / 1000, kMaxStamp_ns / 1000);
}

HostTime time_of_stamp(std::int64_t timestamp_us, std::int64_t realtime_offset_ns) {
  const std::int64_t offset_ns = std::clamp(realtime_offset_ns, -kMaxStamp_ns, kMaxStamp_ns);
  return host_time(std::clamp(bounded_us(timestamp_us) * 1000 - offset_ns, -kMaxStamp_ns, kMaxStamp_ns));
}

HostTime LogOrigin::time(std::int64_t timestamp_us) const {
  return time_of_stamp(timestamp_us, info.realtime_offset_ns);
}

void LogClockDetector::observe(const LogEvent& event) {
  if (event.channel == channels::kLogInfo) {
    if (!log_info_) log_info_ = decode<log_info_t>(event.data.data(), event.data.size());
    return;  // the head is stamped ahead of the run
  }
  const auto header = peek_header(event.data.data(), event.data.size());
  // Bytes of another system may read as a header, but do not begin with a fingerprint of this system.
  if (type_of(event.data) == nullptr) return;
  // Not published at that time: a replay of another log, recorded during a run, and the scene at the head.
  if (!header || event.channel == channels::kSceneManifest || event.channel == channels::kAssetChunk) return;
  auto it = pairs_.find({header->run_id, header->clock});
  if (it == pairs_.end()) {
    if (pairs_.size() >= kMaxPairs) {
      const auto rarest = std::min_element(pairs_.begin(), pairs_.end(), [](const auto& a, const auto& b) {
        return a.second.events < b.second.events;
      });
      if (rarest->second.events > 1) return;
      pairs_.erase(rarest);
    }
    it = pairs_.emplace(std::pair{header->run_id, header->clock}, Pair{}).first;
  }
  Pair& pair = it->second;
  ++pair.events;
  if (header->source == static_cast<std::int32_t>(fnv1a_32("recorder"))) ++pair.of_recorder;
  const std::int64_t stamp_ns = bounded_us(event.timestamp_us) * 1000;
  if (pair.differences_ns.size() < kMaxSamples && header->publish_time_ns <= INT64_MAX / 2)
    pair.differences_ns.push_back(stamp_ns - header->publish_time_ns);
}

std::int64_t LogClockDetector::messages_with_run() const {
  std::int64_t sum = 0;
  for (const auto& [key, pair] : pairs_) sum += pair.events;
  return sum;
}

LogClockDetector::Pairs::const_iterator LogClockDetector::likeliest_pair() const {
  const auto more = [](const auto& a, const auto& b) {
    const bool of_a = a.second.of_recorder >= kMinRecorderMessages, of_b = b.second.of_recorder >= kMinRecorderMessages;
    return of_a != of_b ? of_b : a.second.events < b.second.events;
  };
  return std::max_element(pairs_.begin(), pairs_.end(), more);
}

std::int64_t LogClockDetector::offset_ns(const Pair& pair) {
  std::vector<std::int64_t> d = pair.differences_ns;
  if (d.empty()) return 0;
  const auto at = d.begin() + static_cast<std::ptrdiff_t>(d.size() / 20);
  std::nth_element(d.begin(), at, d.end());
  return *at;
}

LogOrigin LogClockDetector::find() const {
  LogOrigin origin;
  const auto found = likeliest_pair();
  if (log_info_) {
    origin.info = *log_info_;
    origin.known = true;
    if (found == pairs_.end()) return origin;
    const auto own = pairs_.find({log_info_->header.run_id, log_info_->header.clock});
    const bool of_this_run = std::any_of(pairs_.begin(), pairs_.end(),
                                         [&](const auto& p) { return p.first.first == log_info_->header.run_id; });
    const bool contradicted = found->second.of_recorder >= kMinRecorderMessages;
    if (own == pairs_.end() && of_this_run && !contradicted) return origin;
    if (own != pairs_.end() && !own->second.differences_ns.empty()) {
      const std::int64_t estimate = offset_ns(own->second);
      if (std::llabs(estimate / 1000 - log_info_->realtime_offset_ns / 1000) <= kContradiction_ns / 1000)
        return origin;
      origin.info.realtime_offset_ns = estimate;
      origin.recovered =
          "its LOG_INFO contradicts the times of its messages; the times of the messages are used, accurate to "
          "one latency";
      return origin;
    }
  }
  if (found == pairs_.end()) return origin;
  origin.known = true;
  origin.info.header.run_id = found->first.first;
  origin.info.header.clock = found->first.second;
  origin.info.realtime_offset_ns = offset_ns(found->second);
  origin.recovered = std::string("its LOG_INFO is ") + (log_info_ ? "not of this run" : "missing or damaged") +
                     "; run and clock are taken from the headers of " + std::to_string(found->second.events) +
                     " messages; the times are accurate to one latency";
  return origin;
}

}  // namespace tactus::sync
