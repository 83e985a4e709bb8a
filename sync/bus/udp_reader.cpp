#include "sync/bus/udp_reader.h"

#include <poll.h>

#include <chrono>

#include "sync/clocks/pacing.h"

namespace tactus::sync {
namespace {

using std::chrono::milliseconds;

// A default Debian buffers about 90 of the largest messages per socket (net.core.rmem_max); a busy bus carries 6 a
// millisecond.
constexpr Nanoseconds kUnattended = milliseconds(4);
// Limit of the stored messages while the loop is held up: four seconds of a busy bus. Beyond it the kernel's buffers fill,
// and the kernel counts the dropped datagrams.
constexpr std::size_t kMaxKeptBytes = 16 << 20;
constexpr int kTurn = 256;
// Event-driven processes only count and coordinate, so they can wait; they wake a third as often as with 1 ms.
constexpr Nanoseconds kTogether = milliseconds(3);

}  // namespace

UdpReader::UdpReader(const std::string& group, int port)
    : sides_{Side{UdpPort(group, port)}, Side{UdpPort(group, port + 1)}}, attended_(host_now()) {
  thread_ = std::thread([this] { relieve(); });
}

UdpReader::~UdpReader() {
  stop_ = true;
  thread_.join();
}

void UdpReader::attended() { attended_.store(host_now(), std::memory_order_relaxed); }

void UdpReader::wait(Nanoseconds at_most) {
  attended_.store(HostTime::max(), std::memory_order_relaxed);
  const bool kept = [&] {
    if (busy_.test_and_set(std::memory_order_acquire)) return true;
    const bool any = sides_[0].kept.size() > 0 || sides_[1].kept.size() > 0;
    busy_.clear(std::memory_order_release);
    return any;
  }();
  if (!kept) {
    pollfd fds[2] = {{sides_[0].port.descriptor(), POLLIN, 0}, {sides_[1].port.descriptor(), POLLIN, 0}};
    const std::int64_t ns = at_most.count();
    const timespec timeout{ns / 1'000'000'000, ns % 1'000'000'000};
    if (ppoll(fds, 2, &timeout, nullptr) > 0 && at_most > kTogether) std::this_thread::sleep_for(kTogether);
  }
  attended();
}

void UdpReader::relieve() {
  while (!stop_) {
    std::this_thread::sleep_for(kUnattended);
    if (busy_.test_and_set(std::memory_order_acquire)) continue;
    const HostTime now = host_now();
    const bool alone = now - attended_.load(std::memory_order_relaxed) > kUnattended;
    for (Side& side : sides_) {
      if (!alone) break;
      const auto keep = [&](const ChannelBytes& m) { side.kept.add(now, m, kMaxKeptBytes + kTurn * 2048); };
      while (side.kept.bytes() < kMaxKeptBytes && side.port.read(kTurn, keep) == kTurn) continue;
    }
    busy_.clear(std::memory_order_release);
  }
}

}  // namespace tactus::sync
