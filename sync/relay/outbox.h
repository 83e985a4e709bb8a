// The send queue of one line, limited to the bit rate of the line. Bounded in time and in bytes: datagrams that have waited
// too long are dropped and counted, so that a slow line has a bounded delay. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "sync/time/time.h"

namespace tactus::sync {

// The order of sending.
enum class Urgency : std::uint8_t { kFirst = 0, kState = 1, kBulk = 2 };

struct OutboxCounts {
  std::int64_t sent = 0, bytes = 0;  // of datagrams, without their headers
  std::int64_t late = 0;             // dropped events and states
  std::int64_t late_bulk = 0;        // dropped assets: the receiver requests them again
  std::int64_t refused = 0;          // by the network
};

class Outbox {
 public:
  // Maximum waiting time: of events, the time during which sim_node repeats them; assets are requested again after 100 ms
  // (sync/assets/scene_receiver.h), repeatedly.
  static constexpr Nanoseconds kMaxAge{50'000'000}, kMaxBulkAge{1'000'000'000};
  // Burst size: ten of the longest datagrams. Half of it is reserved from assets, so that messages published together are
  // sent together while a scene is in transfer.
  static constexpr double kBurstBytes = 16'000, kReservedBytes = kBurstBytes / 2;
  static constexpr std::size_t kMaxBytes = 1 << 20;  // of each urgency
  static constexpr std::size_t kHeaders = 28;         // IP and UDP (RFC 791, RFC 768), of each datagram

  // bit_per_s 0: unlimited.
  explicit Outbox(double bit_per_s) : bit_per_s_(bit_per_s) {}

  void push(Urgency urgency, std::vector<std::uint8_t> datagram, HostTime now);
  // Calls send(datagram) for the datagrams that may be sent by now; when it returns false, the network refused the datagram,
  // which is dropped.
  template <class Send>
  void flush(HostTime now, Send&& send) {
    refill(now);
    for (const Urgency urgency : {Urgency::kFirst, Urgency::kState, Urgency::kBulk}) {
      Queue& queue = queue_of(urgency);
      drop_late(urgency, now);
      while (!queue.waiting.empty() && may_send(urgency, queue.waiting.front().datagram.size())) {
        const std::vector<std::uint8_t> datagram = take_first(queue);
        if (!send(std::span<const std::uint8_t>(datagram))) ++counts_.refused;
      }
      if (!queue.waiting.empty()) return;  // less urgent datagrams must not overtake it
    }
  }
  const OutboxCounts& counts() const { return counts_; }

 private:
  struct Pending {
    HostTime since;
    std::vector<std::uint8_t> datagram;
  };
  struct Queue {
    std::deque<Pending> waiting{};
    std::size_t bytes = 0;
  };
  Queue& queue_of(Urgency urgency) { return queues_[static_cast<std::size_t>(urgency)]; }
  void refill(HostTime now);
  // Drops datagrams that have waited too long, or exceed the limit.
  void drop_late(Urgency urgency, HostTime now);
  bool may_send(Urgency urgency, std::size_t bytes) const {
    const double kept = urgency == Urgency::kBulk ? kReservedBytes : 0;
    return bit_per_s_ <= 0 || tokens_ >= static_cast<double>(bytes + kHeaders) + kept;
  }
  std::vector<std::uint8_t> take_first(Queue& queue);

  double bit_per_s_;
  double tokens_ = kBurstBytes;  // bytes
  HostTime refilled_{};
  std::array<Queue, 3> queues_;
  OutboxCounts counts_;
};

}  // namespace tactus::sync
