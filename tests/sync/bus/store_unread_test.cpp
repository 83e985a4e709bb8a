#include "sync/bus/store_unread.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace tactus;
using namespace tactus::sync;

namespace {

constexpr HostTime kReceived = host_time(1'000'000'000);
// As many datagrams as a socket holds: 4 MB, each with 256 bytes and its overhead of 512 (sync/bus/receive_buffer.h).
constexpr int kSocketHolds = 21'845;

// A port on which datagrams wait: -1 malformed, otherwise a message of that size.
struct FloodedPort {
  std::vector<int> waiting;
  std::size_t next = 0;
  bool endless = false;  // the last one repeats for ever
  std::int64_t reads = 0;

  template <class OnMessage>
  int read(int max_datagrams, OnMessage&& on_message) {
    static const std::vector<std::uint8_t> bytes(channels::kMaxMessageBytes);
    int count = 0;
    for (; count < max_datagrams && (endless || next < waiting.size()); ++count) {
      const int size = waiting[std::min(next++, waiting.size() - 1)];
      if (size >= 0) on_message(ChannelBytes{"A", std::span(bytes).first(static_cast<std::size_t>(size))});
    }
    reads += count;
    return count;
  }
};

}  // namespace

TEST_CASE("Reading while the loop is held up ends in a flood of malformed datagrams that never ends") {
  FloodedPort port{{-1}};
  port.endless = true;
  MessageBatch stored;
  const int got = store_unread(port, stored, kReceived);
  CHECK(got == port.reads);
  CHECK(got >= kSocketHolds);  // a full socket is emptied
  CHECK(got < kMaxRead + kStoreBatch);
  CHECK(stored.size() == 0);
  CHECK(stored.bytes() == 0);
}

TEST_CASE("Reading while the loop is held up stores a bounded number of bytes, in a flood of any mixture") {
  std::mt19937 random(8);
  for (int trial = 0; trial < 20; ++trial) {
    FloodedPort port;
    const int malformed_percent = static_cast<int>(random() % 101), largest = static_cast<int>(random() % (channels::kMaxMessageBytes + 1));
    for (int i = 0; i < 40'000; ++i)
      port.waiting.push_back(static_cast<int>(random() % 100) < malformed_percent ? -1 : static_cast<int>(random() % (static_cast<unsigned>(largest) + 1)));
    MessageBatch stored;
    for (int pass = 0; pass < 5; ++pass) {
      const std::int64_t before = port.reads;
      const int got = store_unread(port, stored, kReceived);
      CAPTURE(trial, malformed_percent, largest, pass);
      CHECK(got == port.reads - before);
      CHECK(got < kMaxRead + kStoreBatch);
      CHECK(stored.bytes() <= kMaxStoredBytes + kStoreBatch * 2048);
      // It stops only for the bounds, or because nothing waits.
      CHECK((got >= kMaxRead || stored.bytes() >= kMaxStoredBytes || port.next == port.waiting.size()));
    }
  }
}

TEST_CASE("A few waiting datagrams are all stored, in order") {
  FloodedPort port{{3, -1, 1, 0, -1, 2}};
  MessageBatch stored;
  CHECK(store_unread(port, stored, kReceived) == 6);
  REQUIRE(stored.size() == 4);
  for (const auto& [i, size] : {std::pair<std::size_t, std::size_t>{0, 3}, {1, 1}, {2, 0}, {3, 2}}) CHECK(stored[i].data.size() == size);
  CHECK(stored[0].arrival == kReceived);
}
