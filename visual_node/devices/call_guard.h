// Watchdog for blocking calls to the display server. A call that never returns would hang the node and a supervisor
// would never restart it, so a thread ends the process with one sentence.
#pragma once

#include <atomic>
#include <cstdint>
#include <stop_token>
#include <thread>

namespace tactus::visual {

class CallGuard {
 public:
  // Design: the process ends when kMaxChecks consecutive checks, kCheckInterval_ms apart, find the same call in
  // progress: after 5 s. A call on a loaded desktop may take 1 s.
  static constexpr int kMaxChecks = 10, kCheckInterval_ms = 500;

  CallGuard();
  // Runs `call`, under the watchdog. Never waits. Call from one thread only.
  template <class Call>
  void run_guarded(Call&& call) {
    calls_.fetch_add(1, std::memory_order_relaxed);  // odd: a call is in progress
    call();
    calls_.fetch_add(1, std::memory_order_relaxed);
  }

 private:
  void watch(const std::stop_token& stop);

  std::atomic<std::uint64_t> calls_{0};
  std::jthread thread_;
};

}  // namespace tactus::visual
