#include "visual_node/devices/call_guard.h"

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string_view>

namespace tactus::visual {

CallGuard::CallGuard() : thread_([this](const std::stop_token& stop) { watch(stop); }) {}

void CallGuard::watch(const std::stop_token& stop) {
  std::mutex mutex;  // of this thread alone: to be woken at the end
  std::condition_variable_any ended;
  std::unique_lock lock(mutex);
  std::uint64_t seen = 0;
  int looks = 0;
  while (!stop.stop_requested()) {
    ended.wait_for(lock, stop, std::chrono::milliseconds(kLook_ms), [] { return false; });
    const std::uint64_t now = calls_.load(std::memory_order_relaxed);
    looks = now % 2 == 1 && now == seen ? looks + 1 : 0;
    seen = now;
    if (looks < kMaxLooks) continue;
    constexpr std::string_view kSaid =
        "visual_node: the display server does not answer: the node ends; see whether the desktop hangs, or leave "
        "--window out\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kSaid.data(), kSaid.size());
    _exit(1);  // nothing of the process can be put in order while its loop hangs
  }
}

}  // namespace tactus::visual
