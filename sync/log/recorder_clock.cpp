#include "sync/log/recorder_clock.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "lcmtypes/fields.h"
#include "sync/log/log_header.h"
#include "sync/log/log_origin.h"

namespace tactus::sync {
namespace {

constexpr int kNeighbours = 8;         // events that confirm or contradict one stamp
constexpr int kFirstEvents = 32;       // events that confirm the first stamp
constexpr int kMaxAhead = 16'384;      // events that confirm a jump
constexpr std::int64_t kAhead_us = 500'000, kSettled_us = 250'000;  // a backlog of delayed messages is shorter than kSettled_us
constexpr std::int64_t kMaxLatency_us = 1'000'000;
constexpr std::int64_t kMinContradiction_us = 300'000;

std::int64_t median(std::vector<std::int64_t> v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

// Near the smallest, and robust against damaged values.
std::int64_t low_quantile(std::vector<std::int64_t> v) {
  const auto at = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 20);
  std::nth_element(v.begin(), at, v.end());
  return *at;
}

}  // namespace

StampSample stamp_sample(const LogEvent& event) {
  StampSample sample{bounded_us(event.timestamp_us), false, 0, 0};
  // Bytes of another system may read as a header, but do not begin with a fingerprint of this system.
  if (type_of(event.data) == nullptr) return sample;
  const auto header = peek_header(event.data.data(), event.data.size());
  if (!header) return sample;
  sample.has_sender = true;
  sample.sender = static_cast<std::uint64_t>(header->incarnation) * 0x9E3779B97F4A7C15 ^ static_cast<std::uint32_t>(header->source);
  sample.publish_us = header->publish_time_ns / 1000;
  return sample;
}

std::optional<std::int64_t> RecorderClock::excess_us(const StampSample& sample) const {
  const auto it = sample.has_sender ? senders_.find(sample.sender) : senders_.end();
  if (it == senders_.end() || !it->second.known()) return std::nullopt;
  return sample.stamp_us + shift_us_ - sample.publish_us - it->second.offset_us;
}

std::int64_t RecorderClock::Recent::floor_us() const {
  auto sorted = us;
  const auto third = sorted.begin() + 2;
  std::nth_element(sorted.begin(), third, sorted.begin() + static_cast<std::ptrdiff_t>(std::min(count, kRecent)));
  return *third;
}

// No latency makes a message arrive before it was sent.
bool RecorderClock::implausible(std::int64_t offset_us, std::int64_t usual_us) {
  return offset_us < usual_us - kPause_us || offset_us > usual_us + kMaxStep_us;
}

void RecorderClock::learn(const StampSample& sample, std::int64_t us) {
  if (!sample.has_sender) return;
  const std::int64_t offset_us = us - sample.publish_us;
  const auto it = senders_.find(sample.sender);
  if (it == senders_.end() && senders_.size() >= kMaxSenders) return;
  Sender& sender = it == senders_.end() ? senders_[sample.sender] : it->second;
  if (!sender.known()) {
    sender.agreeing.add(offset_us);
    if (!sender.known()) return;
    sender.offset_us = sender.agreeing.floor_us();
    sender.publish_us = us - sender.offset_us;
    for (std::size_t i = 0; i < sender.agreeing.count; ++i) contradicting_ += implausible(sender.agreeing.us[i], sender.offset_us);
    return;
  }
  const double passed_us = std::max(0.0, static_cast<double>(sample.publish_us) - static_cast<double>(sender.publish_us));
  const std::int64_t relaxed_us = sender.offset_us + std::llround(std::min(1e9, kMaxDrift * passed_us));
  if (offset_us < relaxed_us - kPause_us || offset_us > relaxed_us + kPause_us) return contradict(sender, sample, us, relaxed_us);
  contradicting_ += std::exchange(sender.implausible, 0);
  sender.contradicting = {};
  sender.agreeing.add(offset_us);
  sender.offset_us = std::min(relaxed_us, sender.agreeing.floor_us());
  sender.publish_us = std::max(sender.publish_us, sample.publish_us);
}

// Its time contradicts the others: the message is false or was delayed, or the sender replays its messages. Several such messages
// in a row set its offset.
void RecorderClock::contradict(Sender& sender, const StampSample& sample, std::int64_t us, std::int64_t relaxed_us) {
  const std::int64_t offset_us = us - sample.publish_us;
  if (sender.contradicting.count == 0) sender.contradicted_since_us = us;
  sender.contradicting.add(offset_us);
  sender.implausible += implausible(offset_us, relaxed_us);
  if (sender.contradicting.count < kMinLearned || us - sender.contradicted_since_us < kMinContradiction_us) return;
  const Recent found = sender.contradicting;
  sender = {};
  sender.agreeing = found;
  sender.offset_us = found.floor_us();
  sender.publish_us = us - sender.offset_us;
}

RecorderClock::Result RecorderClock::accept(const StampSample& sample, std::int64_t us, std::int64_t jump_us) {
  learn(sample, us);
  if (us < newest_us_) return {Order::kLate, us, jump_us};
  newest_us_ = us;
  return {Order::kInOrder, us, jump_us};
}

RecorderClock::Result RecorderClock::start(const StampSample& sample, const LogScanner& following) {
  std::vector<std::int64_t> stamps{sample.stamp_us};
  LogScanner scanner = following;
  LogEvent event;
  for (int i = 0; i < kFirstEvents && scanner.next(event); ++i) stamps.push_back(bounded_us(event.timestamp_us));
  const std::int64_t middle = median(stamps);
  if (stamps.size() > 2 && std::abs(sample.stamp_us - middle) > kMaxStep_us) {
    newest_us_ = middle;
    for (const std::int64_t stamp : stamps)
      if (std::abs(stamp - middle) <= kMaxStep_us) newest_us_ = std::min(newest_us_, stamp);
    return misdated();
  }
  started_ = true;
  newest_us_ = sample.stamp_us;
  return accept(sample, sample.stamp_us);
}

RecorderClock::Result RecorderClock::observe(const StampSample& sample, const LogScanner& following) {
  if (!started_) return start(sample, following);
  if (budget_ < 1'000'000) budget_ += 4;
  const std::int64_t us = sample.stamp_us + shift_us_, step_us = us - newest_us_;
  const auto excess = excess_us(sample);
  if (step_us >= 0 && step_us <= kPause_us) return accept(sample, us);
  if (step_us > 0 && excess && std::abs(*excess) <= kMinJump_us) return accept(sample, us);  // nothing was sent
  if (step_us < 0 && excess && *excess >= -kMinJump_us && *excess <= kMaxLatency_us) return accept(sample, us);
  return examine(sample, us, following);
}

// True when this stamp alone contradicts the stamps after it, which continue at the time before it.
bool RecorderClock::is_single(std::int64_t us, const LogScanner& following) const {
  LogScanner scanner = following;
  LogEvent event;
  int events = 0, continuing = 0;
  for (; events < kNeighbours && scanner.next(event); ++events) {
    const std::int64_t next_us = bounded_us(event.timestamp_us) + shift_us_;
    continuing += next_us >= newest_us_ - kPause_us && (us < newest_us_ || next_us < us - kPause_us / 2);
  }
  return events > 0 && 2 * continuing >= events;
}

RecorderClock::Votes RecorderClock::votes(const StampSample& sample, const LogScanner& following) {
  struct Excess {
    std::vector<std::int64_t> all, settled;
  };
  std::unordered_map<std::uint64_t, Excess> by_sender;
  std::int64_t settled = 0;
  Votes votes;
  LogScanner scanner = following;
  LogEvent event;
  StampSample next = sample;
  for (int i = 0; i < kMaxAhead && budget_ > 0; ++i, --budget_) {
    const std::int64_t after_us = next.stamp_us - sample.stamp_us;
    if (std::abs(after_us) <= kMaxStep_us) {
      ++votes.confirming;
      if (const auto excess = excess_us(next)) {
        ++votes.messages;
        by_sender[next.sender].all.push_back(*excess);
        if (after_us >= kSettled_us) by_sender[next.sender].settled.push_back(*excess), ++settled;
      }
    }
    if ((after_us > kAhead_us && after_us <= kMaxStep_us && i >= kFirstEvents) || !scanner.next(event)) break;
    next = stamp_sample(event);
  }
  std::vector<std::int64_t> jumps;
  for (auto& [sender, excess] : by_sender) {
    const auto& values = settled >= kMinVotes ? excess.settled : excess.all;
    if (!values.empty()) jumps.push_back(low_quantile(values));
  }
  if (!jumps.empty()) votes.jump_us = median(jumps);
  return votes;
}

// A step that the time of sending does not explain, or of a message without one.
RecorderClock::Result RecorderClock::examine(const StampSample& sample, std::int64_t us, const LogScanner& following) {
  const std::int64_t step_us = us - newest_us_;
  const bool known = excess_us(sample).has_value();
  if (!known && step_us < 0 && step_us >= -kMaxLatency_us) return accept(sample, us);
  if (is_single(us, following)) return misdated();
  if (budget_ <= 0) return misdated();
  const Votes found = votes(sample, following);
  if (found.messages >= kMinVotes && std::abs(found.jump_us) > kMinJump_us &&
      (std::abs(found.jump_us) <= kMaxStep_us || found.messages >= kMinRunEvents)) {
    shift_us_ -= found.jump_us;
    return accept(sample, us - found.jump_us, found.jump_us);
  }
  if (found.messages >= kMinVotes && std::abs(found.jump_us) <= kMinJump_us)
    return step_us > 0 || step_us >= -kMaxStep_us ? accept(sample, us) : misdated();  // the messages were delayed
  if (step_us > 0) {
    const bool confirmed = known ? step_us <= kMaxStep_us : step_us <= kMaxStep_us || found.confirming > 1;
    return confirmed ? accept(sample, us) : misdated();
  }
  if (found.confirming < kMinRunEvents) return misdated();
  shift_us_ -= step_us;
  return accept(sample, newest_us_, step_us);
}

}  // namespace tactus::sync
