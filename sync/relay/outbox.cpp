#include "sync/relay/outbox.h"

#include <algorithm>

namespace tactus::sync {

void Outbox::push(Urgency urgency, std::vector<std::uint8_t> datagram, HostTime now) {
  Queue& queue = queue_of(urgency);
  queue.bytes += datagram.size();
  queue.waiting.push_back({now, std::move(datagram)});
  drop_late(urgency, now);
}

void Outbox::refill(HostTime now) {
  if (refilled_ != HostTime{} && now > refilled_)
    tokens_ = std::min(kBurstBytes, tokens_ + to_seconds(now - refilled_) * bit_per_s_ / 8);
  refilled_ = now;
}

void Outbox::drop_late(Urgency urgency, HostTime now) {
  Queue& queue = queue_of(urgency);
  const bool bulk = urgency == Urgency::kBulk;
  const HostTime oldest = now - (bulk ? kMaxBulkAge : kMaxAge);
  while (!queue.waiting.empty() && (queue.waiting.front().since < oldest || queue.bytes > kMaxBytes)) {
    queue.bytes -= queue.waiting.front().datagram.size();
    queue.waiting.pop_front();
    ++(bulk ? counts_.late_bulk : counts_.late);
  }
}

std::vector<std::uint8_t> Outbox::take_first(Queue& queue) {
  std::vector<std::uint8_t> datagram = std::move(queue.waiting.front().datagram);
  queue.waiting.pop_front();
  queue.bytes -= datagram.size();
  if (bit_per_s_ > 0) tokens_ -= static_cast<double>(datagram.size() + kHeaders);
  ++counts_.sent;
  counts_.bytes += static_cast<std::int64_t>(datagram.size());
  return datagram;
}

}  // namespace tactus::sync
