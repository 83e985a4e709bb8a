// A call of the display server that does not come back would hold the node for ever, and nobody would start it
// again: a thread watches, and ends the process with one sentence instead.
#pragma once

#include <atomic>
#include <cstdint>
#include <stop_token>
#include <thread>

namespace tactus::visual {

class CallGuard {
 public:
  // design: so many looks, so far apart, find the same call under way: 5 s. A desktop under load may need one.
  static constexpr int kMaxLooks = 10, kLook_ms = 500;

  CallGuard();
  // Around each call. Never waits. Of one thread.
  template <class Call>
  void during(Call&& call) {
    calls_.fetch_add(1, std::memory_order_relaxed);  // odd: under way
    call();
    calls_.fetch_add(1, std::memory_order_relaxed);
  }

 private:
  void watch(const std::stop_token& stop);

  std::atomic<std::uint64_t> calls_{0};
  std::jthread thread_;
};

}  // namespace tactus::visual
