// A batch of encoded messages in order of arrival; clear() keeps its memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sync/bus/datagram.h"
#include "sync/time/time.h"

namespace tactus::sync {

class MessageBatch {
  struct Entry {
    HostTime arrival;
    std::uint32_t channel_bytes;
    std::uint32_t data_bytes;
    std::size_t at;
    bool complete;
  };

 public:
  // Refers to the batch.
  struct Message : ChannelBytes {
    HostTime arrival;
  };

  // Returns false without adding when the batch would take more than max_bytes.
  bool add(HostTime arrival, const ChannelBytes& message, std::size_t max_bytes);
  void clear();
  std::size_t size() const { return entries_.size(); }
  // Memory in use, bytes.
  std::size_t bytes() const { return bytes_.size() + entries_.size() * sizeof(Entry); }
  Message operator[](std::size_t i) const;

 private:
  std::vector<Entry> entries_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace tactus::sync
