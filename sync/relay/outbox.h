// What waits to go over one line, at no more bits a second than it carries. Bounded in time and in bytes: what is
// not gone by then is given up and counted, so that a slow line is late by so much and no more. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "sync/time/time.h"

namespace tactus::sync {

// In this order they go.
enum class Urgency : std::uint8_t { kFirst = 0, kState = 1, kBulk = 2 };

struct OutboxCounts {
  std::int64_t sent = 0, bytes = 0;  // of datagrams, less their headers
  std::int64_t late = 0;             // events and states that were given up
  std::int64_t late_bulk = 0;        // assets likewise: they are asked for again
  std::int64_t refused = 0;          // by the network
};

class Outbox {
 public:
  // So long an event is repeated (sim_node), and so long it waits; assets are asked for again after 100 ms
  // (sync/assets/scene_exchange.h), some times more.
  static constexpr Nanoseconds kLatest{50'000'000}, kLatestBulk{1'000'000'000};
  // At once: ten of the longest datagrams. Half of that is never taken by assets, so that what is said together
  // goes together while a scene is on its way.
  static constexpr double kBurstBytes = 16'000, kNotForBulkBytes = kBurstBytes / 2;
  static constexpr std::size_t kMaxBytes = 1 << 20;  // of each urgency
  static constexpr std::size_t kHeaders = 28;         // IP and UDP (RFC 791, RFC 768), of each datagram

  // bit_per_s 0: as much as comes.
  explicit Outbox(double bit_per_s) : bit_per_s_(bit_per_s) {}

  void push(Urgency urgency, std::vector<std::uint8_t> datagram, HostTime now);
  // Calls send(datagram) for what may go by now; false from it: the network took it not, and it is gone.
  template <class Send>
  void flush(HostTime now, Send&& send) {
    refill(now);
    for (const Urgency urgency : {Urgency::kFirst, Urgency::kState, Urgency::kBulk}) {
      Queue& queue = queue_of(urgency);
      give_up(urgency, now);
      while (!queue.waiting.empty() && affords(urgency, queue.waiting.front().datagram.size())) {
        const std::vector<std::uint8_t> datagram = take_first(queue);
        if (!send(std::span<const std::uint8_t>(datagram))) ++counts_.refused;
      }
      if (!queue.waiting.empty()) return;  // nothing less urgent overtakes it
    }
  }
  const OutboxCounts& counts() const { return counts_; }

 private:
  struct Waiting {
    HostTime since;
    std::vector<std::uint8_t> datagram;
  };
  struct Queue {
    std::deque<Waiting> waiting{};
    std::size_t bytes = 0;
  };
  Queue& queue_of(Urgency urgency) { return queues_[static_cast<std::size_t>(urgency)]; }
  void refill(HostTime now);
  // Those that have waited too long, or more than there is room for.
  void give_up(Urgency urgency, HostTime now);
  bool affords(Urgency urgency, std::size_t bytes) const {
    const double kept = urgency == Urgency::kBulk ? kNotForBulkBytes : 0;
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
