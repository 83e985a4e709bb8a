#include "sync/bus/udp_reader.h"

#include <poll.h>

#include <chrono>

#include "sync/bus/receive_buffer.h"
#include "sync/bus/store_unread.h"
#include "sync/clocks/pacing.h"

namespace tactus::sync {
namespace {

using std::chrono::milliseconds;

// A default Debian buffers about 90 of the largest messages per socket (net.core.rmem_max); a busy bus carries 6 a
// millisecond.
constexpr Nanoseconds kMaxUnread = milliseconds(4);
// Event-driven processes only count and coordinate, so they can wait; they wake a third as often as with 1 ms.
constexpr Nanoseconds kGatherTime = milliseconds(3);

}  // namespace

UdpReader::UdpReader(const std::string& group, int port)
    : ports_{ReadPort{UdpPort(group, port)}, ReadPort{UdpPort(group, port + 1)}}, last_loop_read_(host_now()) {
  thread_ = std::thread([this] { read_while_loop_is_late(); });
}

UdpReader::~UdpReader() {
  stop_ = true;
  thread_.join();
}

void UdpReader::record_loop_read() { last_loop_read_.store(host_now(), std::memory_order_relaxed); }

void UdpReader::wait(Nanoseconds max_wait) {
  last_loop_read_.store(HostTime::max(), std::memory_order_relaxed);
  const bool stored = [&] {
    if (busy_.test_and_set(std::memory_order_acquire)) return true;
    const bool any = ports_[0].stored.size() > 0 || ports_[1].stored.size() > 0;
    busy_.clear(std::memory_order_release);
    return any;
  }();
  if (!stored) {
    pollfd fds[2] = {{ports_[0].port.descriptor(), POLLIN, 0}, {ports_[1].port.descriptor(), POLLIN, 0}};
    const std::int64_t ns = max_wait.count();
    const timespec timeout{ns / 1'000'000'000, ns % 1'000'000'000};
    if (ppoll(fds, 2, &timeout, nullptr) > 0 && max_wait > kGatherTime) std::this_thread::sleep_for(kGatherTime);
  }
  record_loop_read();
}

void UdpReader::read_while_loop_is_late() {
  drop_receive_buffer_right();
  while (!stop_) {
    std::this_thread::sleep_for(kMaxUnread);
    if (busy_.test_and_set(std::memory_order_acquire)) continue;
    const HostTime now = host_now();
    const bool loop_is_late = now - last_loop_read_.load(std::memory_order_relaxed) > kMaxUnread;
    for (ReadPort& read_port : ports_) {
      if (!loop_is_late) break;
      store_unread(read_port.port, read_port.stored, now);
    }
    busy_.clear(std::memory_order_release);
  }
}

}  // namespace tactus::sync
