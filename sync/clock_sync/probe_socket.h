// A socket on the bus that receives only CLOCK_PROBE, with the arrival time of each message.
//
// It uses LCM's datagram format ("UDP Multicast Protocol Description") without LCM: LCM's receiving thread passes messages on
// through a queue and stamps them with the settable clock in microseconds, and here every microsecond between wire and stamp
// counts.
#pragma once

#include <cstdint>
#include <optional>
#include <tactus/clock_probe_t.hpp>

#include "sync/bus/bus.h"
#include "sync/time/time.h"

namespace tactus::sync {

class ProbeSocket {
 public:
  // Throws std::runtime_error with one sentence.
  explicit ProbeSocket(const BusOptions& options);
  ~ProbeSocket();
  ProbeSocket(const ProbeSocket&) = delete;
  ProbeSocket& operator=(const ProbeSocket&) = delete;

  struct Received {
    clock_probe_t probe;
    HostTime at;  // never earlier than the true arrival
  };
  // The next valid message that arrives before `until`; nullopt at that time or after wake().
  std::optional<Received> receive(HostTime until);
  bool send(const clock_probe_t& probe);
  // Ends a receive(). Thread-safe: yes.
  void wake();

 private:
  std::optional<Received> read_one();
  int socket_ = -1, wake_ = -1;
  std::uint32_t address_ = 0;  // network order
  std::uint16_t port_ = 0;
  std::uint32_t next_number_ = 0;
  Nanoseconds realtime_minus_monotonic_{0};  // of the monotonic clock, when last read
};

}  // namespace tactus::sync
