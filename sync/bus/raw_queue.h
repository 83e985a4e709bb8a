// The encoded messages of a channel, for programs that read any field of any type (lcmtypes/fields.h). Bounded: when full,
// the oldest is dropped and counted. While the queue is disabled, a message costs one comparison.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "lcmtypes/channels.h"
#include "sync/bus/inbox.h"

namespace tactus::sync {

class RawQueue : public InboxBase {
 public:
  RawQueue(std::string channel, std::size_t capacity)
      : InboxBase(std::move(channel)), ring_(std::max<std::size_t>(1, capacity)) {}

  void set_enabled(bool enabled) {
    enabled_ = enabled;
    if (!enabled) size_ = 0;
  }
  // Allocates nothing.
  void accept(const void* data, std::size_t size, HostTime arrival) noexcept override {
    if (!enabled_) return;
    if (size > channels::kMaxMessageBytes) {
      ++count_.bad;
      return;
    }
    count_.newest_arrival = arrival;
    if (size_ == ring_.size()) {
      first_ = (first_ + 1) % ring_.size();
      --size_;
      ++count_.dropped;
    }
    Entry& entry = ring_[(first_ + size_++) % ring_.size()];
    entry.arrival = arrival;
    entry.size = size;
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    std::copy(bytes, bytes + size, entry.bytes.begin());
  }

  // Passes all stored messages to visit(bytes, arrival), oldest first.
  template <class Visit>
  void read(Visit&& visit) {
    for (; size_ > 0; --size_) {
      const Entry& entry = ring_[first_];
      first_ = (first_ + 1) % ring_.size();
      visit(std::span<const std::uint8_t>(entry.bytes.data(), entry.size), entry.arrival);
    }
  }

 private:
  struct Entry {
    HostTime arrival{};
    std::size_t size = 0;
    std::array<std::uint8_t, channels::kMaxMessageBytes> bytes{};
  };
  std::vector<Entry> ring_;
  std::size_t first_ = 0, size_ = 0;
  bool enabled_ = true;
};

}  // namespace tactus::sync
