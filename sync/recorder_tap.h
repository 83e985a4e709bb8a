// Hears everything that crosses both ports of the bus, as bytes, and stamps it on arrival in a thread of its own,
// so that neither decoding nor a slow disk makes a stamp late or a queue full.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string_view>
#include <thread>
#include <vector>

#include "sync/bus.h"
#include "sync/time.h"

namespace tactus::sync {

enum class Tapped {
  kKept,
  kNoRoom,
  kOversized,  // larger than any message of the bus: of nobody that we know, and it would fill the disk
};

// What arrived since the last look, in order. Keeps its memory when cleared.
class TapBatch {
 public:
  struct Message {
    HostTime arrival;
    std::string_view channel;
    std::span<const std::uint8_t> data;
  };

  Tapped add(HostTime arrival, std::string_view channel, std::span<const std::uint8_t> data,
             std::size_t max_bytes);
  void clear();
  std::size_t size() const { return entries_.size(); }
  Message operator[](std::size_t i) const;

 private:
  struct Entry {
    HostTime arrival;
    std::uint32_t channel_bytes;
    std::uint32_t data_bytes;
    std::size_t at;
  };
  std::vector<Entry> entries_;
  std::vector<std::uint8_t> bytes_;
};

class RecorderTap {
 public:
  // Ten seconds of a busy bus.
  static constexpr std::size_t kMaxBatchBytes = 64 << 20;

  // The thread inherits the caller's scheduling. Throws std::runtime_error with one sentence.
  explicit RecorderTap(const BusOptions& options);
  ~RecorderTap();
  RecorderTap(const RecorderTap&) = delete;
  RecorderTap& operator=(const RecorderTap&) = delete;

  // Exchanges an empty batch for what has arrived. Thread-safe.
  void take(TapBatch& batch);
  // Hears what has arrived until now and ends the thread; what is left can still be taken.
  void stop();
  // Messages that found no room because nobody took them.
  std::int64_t overflow() const { return overflow_; }
  // Messages that are left out because they are larger than any of the bus.
  std::int64_t oversized() const { return oversized_; }

 private:
  struct Connections;
  void listen();

  std::unique_ptr<Connections> connections_;
  std::mutex mutex_;
  TapBatch arrived_;
  std::atomic<std::int64_t> overflow_ = 0;
  std::atomic<std::int64_t> oversized_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace tactus::sync
