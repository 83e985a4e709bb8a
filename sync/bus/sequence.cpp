#include "sync/bus/sequence.h"

#include <algorithm>
#include <cstdlib>

namespace tactus::sync {

namespace {
constexpr std::int64_t kEpochNs = 1'000'000'000;
}

SequenceTracker::Sender& SequenceTracker::find_or_add(std::int32_t source) {
  const auto it = senders_.find(source);
  if (it != senders_.end()) return it->second;
  if (senders_.size() >= kMaxSenders) {
    senders_.erase(std::min_element(senders_.begin(), senders_.end(),
                                    [](const auto& a, const auto& b) { return a.second.last_message < b.second.last_message; }));
    ++forgotten_;
  }
  return senders_[source];
}

SequenceStatus SequenceTracker::observe(const header_t& h) {
  Sender& s = find_or_add(h.source);
  const bool first = s.last_message == 0;
  s.last_message = ++messages_;
  const auto restart = [&](SequenceStatus status) {
    s = {h.incarnation, h.seq, h.publish_time_ns, {}, 0, messages_};
    return status;
  };
  if (first || s.incarnation != h.incarnation) return restart(SequenceStatus::kNewIncarnation);
  if (h.publish_time_ns < s.publish_ns - kEpochNs || std::abs(h.seq - s.seq) > kMaxGap)
    return restart(SequenceStatus::kNewEpoch);
  if (h.seq <= s.seq) {
    if (h.publish_time_ns > s.publish_ns) {
      if (++s.contradictions >= kMaxContradictions) return restart(SequenceStatus::kNewEpoch);
    } else {
      const std::int64_t behind = s.seq - 1 - h.seq;
      if (behind >= 0 && behind < kRemembered && s.missing[static_cast<std::size_t>(behind)]) {
        s.missing.reset(static_cast<std::size_t>(behind));
        --gaps_;
      }
    }
    return SequenceStatus::kOld;
  }
  gaps_ += h.seq - s.seq - 1;
  const std::int64_t skipped = std::min(h.seq - s.seq - 1, kRemembered);
  s.missing <<= static_cast<std::size_t>(skipped + 1);
  s.missing |= ~std::bitset<kRemembered>() >> static_cast<std::size_t>(kRemembered - skipped);
  s.seq = h.seq;
  s.publish_ns = h.publish_time_ns;
  s.contradictions = 0;
  return SequenceStatus::kNew;
}

}  // namespace tactus::sync
