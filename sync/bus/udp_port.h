// One receiving port of the bus: a multicast socket that the owner reads in batches, without a thread.
//
// LCM's own receiver wakes a thread for each datagram of the port, on any channel, and passes it on through a pipe. With
// 10,000 malformed messages per second that used 0.8 of a core in eight processes, and a software-rendered picture fell below
// its rate. LCM also reassembles fragments in memory that a forged fragment can overrun (in all releases of LCM, see its pull
// request 628). No message of this bus is fragmented, so this class reassembles none.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "lcmtypes/channels.h"
#include "sync/bus/datagram.h"

namespace tactus::sync {

class UdpPort {
 public:
  // Joins the group on the interface of the route to it. Throws std::system_error.
  UdpPort(const std::string& group, int port);
  ~UdpPort();
  UdpPort(const UdpPort&) = delete;
  UdpPort& operator=(const UdpPort&) = delete;

  int descriptor() const { return socket_; }

  // Calls on_message(ChannelBytes) for the received datagrams, at most `max_messages`, oldest first, without waiting. Returns the number
  // of datagrams read: fewer than `max_messages` when none are left. A message that is too long for the bus is truncated, but
  // stays longer than channels::kMaxMessageBytes. Realtime-safe: yes.
  template <class OnMessage>
  int read(int max_messages, OnMessage&& on_message) {
    int count = 0;
    while (count < max_messages) {
      const int requested = std::min(max_messages - count, kBatch);
      const int got = receive(requested);
      for (int i = 0; i < got; ++i)
        if (const auto message = parse_datagram(datagram(i))) on_message(*message);
      count += got;
      if (got < requested) break;
    }
    return count;
  }

 private:
  static constexpr int kBatch = 32;
  // The longest message with the longest channel name, plus a margin that makes a longer one detectable.
  static constexpr std::size_t kDatagramBytes = channels::kMaxMessageBytes + 136;

  // Receives up to `requested` datagrams into buffers_, at most kBatch. Returns their number.
  int receive(int requested);
  std::span<const std::uint8_t> datagram(int i) const {
    return {buffers_[static_cast<std::size_t>(i)].data(), sizes_[static_cast<std::size_t>(i)]};
  }

  int socket_ = -1;
  std::array<std::array<std::uint8_t, kDatagramBytes>, kBatch> buffers_;
  std::array<std::size_t, kBatch> sizes_{};
};

}  // namespace tactus::sync
