// Hears everything that crosses both ports of the bus, as bytes, and stamps it on arrival in a thread of its own,
// so that neither decoding nor a slow disk makes a stamp late or a queue full. In a virtual time what is sent is heard at once.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>

#include "sync/bus/bus.h"
#include "sync/bus/message_batch.h"
#include "sync/bus/udp_port.h"

namespace tactus::sync {

class RecorderTap {
 public:
  // Ten seconds of a busy bus.
  static constexpr std::size_t kMaxBatchBytes = 64 << 20;

  // The thread inherits the caller's scheduling. Throws std::system_error; join the bus before, which says more.
  explicit RecorderTap(const BusOptions& options);
  ~RecorderTap();
  RecorderTap(const RecorderTap&) = delete;
  RecorderTap& operator=(const RecorderTap&) = delete;

  // Exchanges an empty batch for what has arrived. Thread-safe.
  void take(MessageBatch& batch);
  // Hears what has arrived until now and ends the thread; what is left can still be taken.
  void stop();
  // Messages that found no room because nobody took them.
  std::int64_t overflow() const { return overflow_; }
  // Messages that are left out because they are larger than any of the bus: of nobody that we know, and they would
  // fill the disk.
  std::int64_t oversized() const { return oversized_; }

 private:
  void listen();
  void keep(const ChannelBytes& message);

  struct Ports {
    explicit Ports(const BusOptions& options);
    std::array<UdpPort, 2> both;
  };
  std::optional<Ports> ports_;  // none in a virtual time, whose wire tells
  int told_ = 0;                // number of what its wire calls
  std::mutex mutex_;
  MessageBatch arrived_;
  std::atomic<std::int64_t> overflow_ = 0;
  std::atomic<std::int64_t> oversized_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace tactus::sync
