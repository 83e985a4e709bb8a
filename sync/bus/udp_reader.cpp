#include "sync/bus/udp_reader.h"

#include <poll.h>

#include <chrono>

#include "sync/clocks/pacing.h"

namespace tactus::sync {
namespace {

using std::chrono::milliseconds;

// A default Debian buffers about 90 of the largest messages per socket (net.core.rmem_max); a busy bus carries 6 a
// millisecond.
constexpr Nanoseconds kMaxUnread = milliseconds(4);
// Limit of the stored messages while the loop is held up: four seconds of a busy bus. Beyond it the kernel's buffers fill,
// and the kernel counts the dropped datagrams.
constexpr std::size_t kMaxStoredBytes = 16 << 20;
constexpr int kBatch = 256;
// Datagrams that the thread reads from one port at a time: more than its socket holds. Malformed ones fill no memory, so
// only this bound ends the reading of a flood of them.
constexpr int kMaxRead = 25'000;
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
  while (!stop_) {
    std::this_thread::sleep_for(kMaxUnread);
    if (busy_.test_and_set(std::memory_order_acquire)) continue;
    const HostTime now = host_now();
    const bool loop_is_late = now - last_loop_read_.load(std::memory_order_relaxed) > kMaxUnread;
    for (ReadPort& read_port : ports_) {
      if (!loop_is_late) break;
      const auto store = [&](const ChannelBytes& m) { read_port.stored.add(now, m, kMaxStoredBytes + kBatch * 2048); };
      for (int left = kMaxRead; left > 0 && read_port.stored.bytes() < kMaxStoredBytes; left -= kBatch)
        if (read_port.port.read(kBatch, store) < kBatch) break;
    }
    busy_.clear(std::memory_order_release);
  }
}

}  // namespace tactus::sync
