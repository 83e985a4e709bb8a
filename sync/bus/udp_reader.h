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

  // Calls on_message(side, ChannelBytes) for the received messages, at most `max_messages`, without waiting. side: 0 for the first port,
  // 1 for the next. The order of each port is kept.
  template <class OnMessage>
  void read(int max_messages, OnMessage&& on_message) {
    if (busy_.test_and_set(std::memory_order_acquire)) return;  // the thread is reading: read at the next call
    for (std::size_t i = 0; i < ports_.size(); ++i) {
      ReadPort& read_port = ports_[i];
      for (; read_port.next < read_port.stored.size() && max_messages > 0; ++read_port.next, --max_messages) on_message(i, read_port.stored[read_port.next]);
      if (read_port.next < read_port.stored.size()) continue;
      read_port.stored.clear();
      read_port.next = 0;
      max_messages -= read_port.port.read(max_messages, [&](const ChannelBytes& m) { on_message(i, m); });
    }
    record_loop_read();
    busy_.clear(std::memory_order_release);
  }

  // Waits until a message arrives, at most this time, and then a moment longer: messages that arrive together are handled
  // together, and a flood cannot wake the process more often.
  void wait(Nanoseconds max_wait);

 private:
  struct ReadPort {
    UdpPort port;
    MessageBatch stored{};
    std::size_t next = 0;
  };
  void record_loop_read();
  void read_while_loop_is_late();

  std::array<ReadPort, 2> ports_;
  std::atomic_flag busy_;
  std::atomic<HostTime> last_loop_read_;  // last read by the loop; far in the future while it waits for the sockets
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace tactus::sync
