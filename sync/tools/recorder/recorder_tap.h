// Receives all messages on both ports of the bus, as bytes, and stamps them on arrival in its own thread, so that neither
// decoding nor a slow disk delays a stamp or fills a queue. In virtual time messages are received when they are sent.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>

#include "sync/bus/bus_options.h"
#include "sync/bus/message_batch.h"
#include "sync/bus/udp_port.h"

namespace tactus::sync {

class RecorderTap {
 public:
  // Ten seconds of a busy bus.
  static constexpr std::size_t kMaxBatchBytes = 64 << 20;

  // The thread inherits the caller's scheduling. Throws std::system_error; joining the bus before gives clearer errors.
  explicit RecorderTap(const BusOptions& options);
  ~RecorderTap();
  RecorderTap(const RecorderTap&) = delete;
  RecorderTap& operator=(const RecorderTap&) = delete;

  // Exchanges an empty batch for the received messages. Thread-safe.
  void take(MessageBatch& batch);
  // Receives pending messages and ends the thread, also under a flood; remaining messages can still be taken.
  void stop();
  // Number of messages dropped because the batch was full.
  std::int64_t overflow() const { return overflow_; }
  // Number of messages left out because they are larger than any message of the bus: they come from a foreign program and
  // would fill the disk.
  std::int64_t oversized() const { return oversized_; }

 private:
  void run();
  void store(const ChannelBytes& message);

  struct Ports {
    explicit Ports(const BusOptions& options);
    std::array<UdpPort, 2> both;
  };
  std::optional<Ports> ports_;  // none in virtual time, where the wire delivers the messages
  int listener_ = 0;                // number of the wire's callback
  std::mutex mutex_;
  MessageBatch arrived_;
  std::atomic<std::int64_t> overflow_ = 0;
  std::atomic<std::int64_t> oversized_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace tactus::sync
