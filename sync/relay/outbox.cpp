#include "sync/relay/outbox.h"

#include <algorithm>

namespace tactus::sync {

void Outbox::push(Urgency urgency, std::vector<std::uint8_t> datagram, HostTime now) {
  Queue& queue = queues_[static_cast<std::size_t>(urgency)];
  queue.bytes += datagram.size();
  queue.waiting.push_back({now, std::move(datagram)});
  for (; queue.bytes > kMostBytes; ++counts_.late) {
    queue.bytes -= queue.waiting.front().datagram.size();
    queue.waiting.pop_front();
  }
}

void Outbox::refill(HostTime now) {
  if (refilled_ != HostTime{} && now > refilled_)
    tokens_ = std::min(kBurstBytes, tokens_ + to_seconds(now - refilled_) * bit_per_s_ / 8);
  refilled_ = now;
}

void Outbox::give_up(Queue& queue, HostTime before) {
  for (; !queue.waiting.empty() && queue.waiting.front().since < before; ++counts_.late) {
    queue.bytes -= queue.waiting.front().datagram.size();
    queue.waiting.pop_front();
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
