// Moves the waiting datagrams of a port into memory, while the loop of the process is held up. Pure.
#pragma once

#include <cstddef>

#include "sync/bus/message_batch.h"
#include "sync/time/time.h"

namespace tactus::sync {

// Limit of the stored messages while the loop is held up: four seconds of a busy bus. Beyond it the kernel's buffers fill,
// and the kernel counts the dropped datagrams.
inline constexpr std::size_t kMaxStoredBytes = 16 << 20;
inline constexpr int kStoreBatch = 256;
// Datagrams that are read from one port at a time: more than its socket holds. Malformed ones fill no memory, so only this
// bound ends the reading of a flood of them.
inline constexpr int kMaxRead = 25'000;

// port: int read(int max_datagrams, on_message), as UdpPort. Returns the number of datagrams read, at most kMaxRead and one batch.
// Realtime-safe: no.
template <class Port>
int store_unread(Port& port, MessageBatch& stored, HostTime now) {
  int count = 0;
  const auto store = [&](const ChannelBytes& m) { stored.add(now, m, kMaxStoredBytes + kStoreBatch * 2048); };
  while (count < kMaxRead && stored.bytes() < kMaxStoredBytes) {
    const int got = port.read(kStoreBatch, store);
    count += got;
    if (got < kStoreBatch) break;
  }
  return count;
}

}  // namespace tactus::sync
