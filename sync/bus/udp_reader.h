// Reads both ports of the bus, from the loop of the process, within its tick.
//
// A loop that ticks rarely, or is held up, would overflow the buffers of its sockets. A thread then reads the sockets and
// stores the messages, in order, until the loop reads them. Neither side waits for the other: while one reads, the other
// skips its read.
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
  // Joins the group on `port` and on the next one. The thread inherits the caller's scheduling. Throws std::system_error.
  UdpReader(const std::string& group, int port);
  ~UdpReader();
  UdpReader(const UdpReader&) = delete;
  UdpReader& operator=(const UdpReader&) = delete;

  // Calls hear(side, ChannelBytes) for the received messages, at most `at_most`, without waiting. side: 0 for the first port,
  // 1 for the next. The order of each port is kept.
  template <class Hear>
  void read(int at_most, Hear&& hear) {
    if (busy_.test_and_set(std::memory_order_acquire)) return;  // the thread is reading: read at the next call
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

  // Waits until a message arrives, at most this time, and then a moment longer: messages that arrive together are handled
  // together, and a flood cannot wake the process more often.
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
  std::atomic<HostTime> attended_;  // last read by the loop; far in the future while it waits for the sockets
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace tactus::sync
