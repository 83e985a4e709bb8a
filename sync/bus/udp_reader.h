// Both ports of the bus, read by the loop that needs them, in its own tick.
//
// A loop that ticks seldom, or is held up, would leave more in its sockets than the kernel keeps for it: then a
// thread takes it out and keeps it, in order, until the loop comes. Neither waits for the other: while one reads,
// the other has its turn later.
#pragma once

#include <array>
#include <atomic>
#include <string>
#include <thread>

#include "sync/bus/message_batch.h"
#include "sync/time/time.h"
#include "sync/bus/udp_port.h"

namespace tactus::sync {

class UdpReader {
 public:
  // Joins the group on `port` and on the next one. The thread inherits the caller's scheduling. Throws
  // std::system_error.
  UdpReader(const std::string& group, int port);
  ~UdpReader();
  UdpReader(const UdpReader&) = delete;
  UdpReader& operator=(const UdpReader&) = delete;

  // Calls hear(side, ChannelBytes), side 0 for the first port and 1 for the next, for what has arrived, each
  // port's oldest first, at most `at_most` messages; without waiting.
  template <class Hear>
  void read(int at_most, Hear&& hear) {
    if (busy_.test_and_set(std::memory_order_acquire)) return;  // the thread reads: next time
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      Side& side = sides_[i];
      for (; side.next < side.kept.size() && at_most > 0; ++side.next, --at_most) hear(i, side.kept[side.next]);
      if (side.next < side.kept.size()) continue;
      side.kept.clear();
      side.next = 0;
      at_most -= side.port.read(at_most, [&](const ChannelBytes& m) { hear(i, m); });
    }
    attended();
    busy_.clear(std::memory_order_release);
  }

  // Waits until something arrives, at most so long; then for a moment more, so that what comes together is handled
  // together, and a flood wakes us no more often than that.
  void wait(Nanoseconds at_most);

 private:
  struct Side {
    UdpPort port;
    MessageBatch kept{};
    std::size_t next = 0;
  };
  void attended();
  void relieve();

  std::array<Side, 2> sides_;
  std::atomic_flag busy_;
  std::atomic<HostTime> attended_;  // when the loop last read; far in the future while it waits for the sockets
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace tactus::sync
