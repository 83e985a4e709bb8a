// The thread of sync_node that probes the clocks of other hosts and answers their probes immediately: it blocks only on the
// probe socket. It passes its results to the loop by value through a lock-free queue.
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

// For tests: a clock with a given drift and jump. By default, the host's own clock.
struct EmulatedClock {
  double drift = 0;           // s/s, from `since` on
  Nanoseconds jump{0};        // by this amount, once, at `jump_at`
  HostTime since{}, jump_at = HostTime::max();

  HostTime read(HostTime host) const {
    const auto gained = static_cast<std::int64_t>(static_cast<double>((host - since).count()) * drift);
    return host + Nanoseconds(gained) + (host >= jump_at ? jump : Nanoseconds(0));
  }
};

// A queue for one producer and one consumer, by value. Realtime-safe: yes.
template <class T, std::size_t kCapacity>
class SpscQueue {
 public:
  bool push(const T& item) {
    const std::size_t next = (head_.load(std::memory_order_relaxed) + 1) % kCapacity;
    if (next == tail_.load(std::memory_order_acquire)) return false;
    items_[head_.load(std::memory_order_relaxed)] = item;
    head_.store(next, std::memory_order_release);
    return true;
  }
  std::optional<T> pop() {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return std::nullopt;
    const T item = items_[tail];
    tail_.store((tail + 1) % kCapacity, std::memory_order_release);
    return item;
  }

 private:
  std::array<T, kCapacity> items_{};
  std::atomic<std::size_t> head_{0}, tail_{0};
};

class ProbeThread {
 public:
  // The thread runs until the destructor, with the caller's scheduling. Throws std::runtime_error with one sentence.
  ProbeThread(const BusOptions& options, const Identity& own, const EmulatedClock& clock = {});
  ~ProbeThread();
  ProbeThread(const ProbeThread&) = delete;
  ProbeThread& operator=(const ProbeThread&) = delete;

  // The next completed wave, in order. One consumer.
  std::optional<ProbeWave> pop() { return waves_.pop(); }

 private:
  // Limit on answers, against a flood of requests: eight probes of 64 hosts in half a second, twice (design).
  static constexpr int kMaxRepliesPerPeriod = 1024;

  void run();
  void process(const ProbeSocket::Received&);
  void send(clock_probe_t probe);

  Identity own_;
  EmulatedClock clock_;
  ProbeSocket socket_;
  ClockProber prober_;
  SpscQueue<ProbeWave, 256> waves_;  // a period of all the clocks that a prober tracks, four times
  std::int64_t seq_ = 0;
  int replies_ = 0;  // in this period
  HostTime replies_since_{};
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses all the others
};

}  // namespace tactus::sync
