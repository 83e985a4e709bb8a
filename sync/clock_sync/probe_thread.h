// The thread of sync_node that asks other hosts for their time and answers theirs at once: it blocks on the probes and on
// nothing else. What it learns goes to the loop by value through a queue without locks.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <tactus/clock_probe_t.hpp>
#include <thread>

#include "sync/clock_sync/clock_probe.h"
#include "sync/clocks/pacing.h"
#include "sync/clock_sync/probe_socket.h"

namespace tactus::sync {

// For tests: a clock that drifts and jumps as told. Else the host's own.
struct EmulatedClock {
  double drift = 0;           // s/s, from `since` on
  Nanoseconds jump{0};        // by so much, once, at `jump_at`
  HostTime since{}, jump_at = HostTime::max();

  HostTime read(HostTime host) const {
    const auto gained = static_cast<std::int64_t>(static_cast<double>((host - since).count()) * drift);
    return host + Nanoseconds(gained) + (host >= jump_at ? jump : Nanoseconds(0));
  }
};

// One producer, one consumer, by value. Realtime-safe: yes.
template <class Item, std::size_t kRoom>
class HandOver {
 public:
  bool push(const Item& item) {
    const std::size_t next = (head_.load(std::memory_order_relaxed) + 1) % kRoom;
    if (next == tail_.load(std::memory_order_acquire)) return false;
    items_[head_.load(std::memory_order_relaxed)] = item;
    head_.store(next, std::memory_order_release);
    return true;
  }
  std::optional<Item> pop() {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return std::nullopt;
    const Item item = items_[tail];
    tail_.store((tail + 1) % kRoom, std::memory_order_release);
    return item;
  }

 private:
  std::array<Item, kRoom> items_{};
  std::atomic<std::size_t> head_{0}, tail_{0};
};

class ProbeThread {
 public:
  // Runs from here to the destructor, with the caller's scheduling. Throws std::runtime_error with one sentence.
  ProbeThread(const BusOptions& options, const Identity& own, const EmulatedClock& clock = {});
  ~ProbeThread();
  ProbeThread(const ProbeThread&) = delete;
  ProbeThread& operator=(const ProbeThread&) = delete;

  // The next wave that has ended, in order. One consumer.
  std::optional<ProbeWave> pop() { return waves_.pop(); }

 private:
  // A flood of requests is answered only so often: eight probes of 64 hosts in half a second, twice (design).
  static constexpr int kAnswersPerPeriod = 1024;

  void run();
  void take(const ProbeSocket::Arrived&);
  void send(clock_probe_t probe);

  Identity own_;
  EmulatedClock clock_;
  ProbeSocket socket_;
  ClockProber prober_;
  HandOver<ProbeWave, 256> waves_;  // a period of all the clocks that a prober minds, four times
  std::int64_t seq_ = 0;
  int answers_ = 0;  // in this period
  HostTime answers_since_{};
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses all the others
};

}  // namespace tactus::sync
