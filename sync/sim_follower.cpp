#include "sync/sim_follower.h"

#include <algorithm>

namespace tactus::sync {

Follow SimFollower::follow(const header_t& header, const sim_clock_t& clock, HostTime arrival) {
  Follow verdict = Follow::kSame;
  if (header.incarnation != incarnation_) {
    const bool replaced = std::find(replaced_.begin(), replaced_.end(), header.incarnation) != replaced_.end();
    if (replaced && arrival - last_arrival_ < kSilence) return Follow::kIgnore;
    if (incarnation_ != 0) replaced_.push_back(incarnation_);
    std::erase(replaced_, header.incarnation);
    if (replaced_.size() > kRemembered) replaced_.pop_front();
    incarnation_ = header.incarnation;
    verdict = Follow::kRestart;
  } else if (header.publish_time_ns < newest_publish_ns_ - kEpoch.count()) {
    verdict = Follow::kRestart;
  }
  if (verdict == Follow::kRestart) {
    sender_ = SenderClock(own_);
    newest_publish_ns_ = 0;
  }
  last_arrival_ = arrival;
  sender_.observe(header, arrival);
  if (header.publish_time_ns >= newest_publish_ns_) {
    newest_publish_ns_ = header.publish_time_ns;
    clock_ = clock;
  }
  return verdict;
}

std::optional<TimeMap> SimFollower::map(HostTime now) const {
  if (incarnation_ == 0) return std::nullopt;
  return TimeMap{sim_time(clock_.sim_ns), sender_.to_host(clock_.host_ns, now), clock_.rate};
}

}  // namespace tactus::sync
