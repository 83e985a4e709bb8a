#include "sync/sequence.h"

#include <algorithm>

namespace tactus::sync {

namespace {
constexpr std::int64_t kEpochNs = 1'000'000'000;
}

Arrival SequenceTracker::observe(const header_t& h) {
  ++messages_;
  auto [it, first] = senders_.try_emplace(h.source);
  Sender& s = it->second;
  if (first || s.incarnation != h.incarnation) {
    s = {h.incarnation, h.seq, h.publish_time_ns, {}};
    return Arrival::kNewIncarnation;
  }
  if (h.publish_time_ns < s.publish_ns - kEpochNs) {
    s = {h.incarnation, h.seq, h.publish_time_ns, {}};
    return Arrival::kNewEpoch;
  }
  if (h.seq <= s.seq) {
    gaps_ -= static_cast<std::int64_t>(s.missing.erase(h.seq));
    return Arrival::kOld;
  }
  gaps_ += h.seq - s.seq - 1;
  for (std::int64_t seq = std::max(s.seq + 1, h.seq - kRemembered); seq < h.seq; ++seq) s.missing.insert(seq);
  while (static_cast<std::int64_t>(s.missing.size()) > kRemembered) s.missing.erase(s.missing.begin());
  s.seq = h.seq;
  s.publish_ns = h.publish_time_ns;
  return Arrival::kNew;
}

}  // namespace tactus::sync
