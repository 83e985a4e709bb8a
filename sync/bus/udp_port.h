// One port of the bus, for receiving: a multicast socket that is read in batches by whoever wants to know, without
// a thread of its own.
//
// LCM's own receiver wakes a thread for each datagram of the port, whatever its channel, and hands it on through a
// pipe; with 10,000 malformed messages a second that took 0.8 of a core from eight processes, and a picture drawn
// on the processor fell below its rate. It also puts fragments together in memory that a forged one can overrun
// (shared by all releases of LCM, see its pull request 628); no message of this bus is fragmented, so none is put
// together here.
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
  // Joins the group on the interface that the route to it names. Throws std::system_error.
  UdpPort(const std::string& group, int port);
  ~UdpPort();
  UdpPort(const UdpPort&) = delete;
  UdpPort& operator=(const UdpPort&) = delete;

  int descriptor() const { return socket_; }

  // Calls hear(ChannelBytes) for what has arrived, at most `at_most` datagrams, oldest first; waits for nothing.
  // Returns how many datagrams were read: fewer than `at_most` when none are left. A message that is too long for
  // the bus is cut, to more than channels::kMaxMessageBytes. Realtime-safe: yes.
  template <class Hear>
  int read(int at_most, Hear&& hear) {
    int count = 0;
    while (count < at_most) {
      const int wanted = std::min(at_most - count, kBatch);
      const int got = receive(wanted);
      for (int i = 0; i < got; ++i)
        if (const auto message = parse_datagram(datagram(i))) hear(*message);
      count += got;
      if (got < wanted) break;
    }
    return count;
  }

 private:
  static constexpr int kBatch = 32;
  // The longest message with the longest channel, and then some, so that one which is longer shows.
  static constexpr std::size_t kDatagramBytes = channels::kMaxMessageBytes + 136;

  // Receives up to `wanted` datagrams into buffers_, no more than kBatch. Returns how many.
  int receive(int wanted);
  std::span<const std::uint8_t> datagram(int i) const {
    return {buffers_[static_cast<std::size_t>(i)].data(), sizes_[static_cast<std::size_t>(i)]};
  }

  int socket_ = -1;
  std::array<std::array<std::uint8_t, kDatagramBytes>, kBatch> buffers_;
  std::array<std::size_t, kBatch> sizes_{};
};

}  // namespace tactus::sync
