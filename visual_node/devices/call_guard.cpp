#include "visual_node/devices/call_guard.h"

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string_view>

namespace tactus::visual {

CallGuard::CallGuard() : thread_([this](const std::stop_token& stop) { watch(stop); }) {}

void CallGuard::watch(const std::stop_token& stop) {
  std::mutex mutex;  // used by this thread only, to wake it at the end
  std::condition_variable_any ended;
  std::unique_lock lock(mutex);
  std::uint64_t seen = 0;
  int stuck_checks = 0;
  while (!stop.stop_requested()) {
    ended.wait_for(lock, stop, std::chrono::milliseconds(kCheckInterval_ms), [] { return false; });
    const std::uint64_t now = calls_.load(std::memory_order_relaxed);
    stuck_checks = now % 2 == 1 && now == seen ? stuck_checks + 1 : 0;
    seen = now;
    if (stuck_checks < kMaxChecks) continue;
    constexpr std::string_view kMessage =
        "visual_node: the display server does not answer, so the node ends; check whether the desktop hangs, or leave "
        "--window out\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kMessage.data(), kMessage.size());
    _exit(1);  // an orderly shutdown is not possible while the loop hangs
  }
}

}  // namespace tactus::visual
