// Tests of queues of undecoded messages.
#include "sync/bus/raw_queue.h"

#include <catch2/catch.hpp>
#include <tactus/media_clock_t.hpp>

#include "sync/bus/bus.h"
#include "sync/bus/decode.h"

using namespace tactus;
using namespace tactus::sync;

namespace {

HostTime at_ms(int ms) { return HostTime{std::chrono::milliseconds(ms)}; }
std::vector<int> read_all(RawQueue& queue) {
  std::vector<int> first;
  queue.read(
      [&](std::span<const std::uint8_t> bytes, HostTime) { first.push_back(bytes.empty() ? -1 : bytes[0]); });
  return first;
}
void put(RawQueue& queue, int number, int ms = 0) {
  const auto byte = static_cast<std::uint8_t>(number);
  queue.accept(&byte, 1, at_ms(ms));
}

}  // namespace

TEST_CASE("A raw queue returns messages in order and counts the oldest ones that it drops when full") {
  RawQueue queue("X", 3);
  CHECK(read_all(queue).empty());
  for (int i = 0; i < 5; ++i) put(queue, i, i);
  CHECK(queue.count().dropped == 2);
  CHECK(queue.count().newest_arrival == at_ms(4));
  CHECK(read_all(queue) == std::vector{2, 3, 4});
  put(queue, 7);
  CHECK(read_all(queue) == std::vector{7});
}

TEST_CASE("A raw queue rejects oversized messages and stores nothing while it is not wanted") {
  RawQueue queue("X", 3);
  const std::vector<std::uint8_t> large(channels::kMaxMessageBytes + 1);
  queue.accept(large.data(), large.size(), at_ms(0));
  CHECK(queue.count().bad == 1);
  queue.accept(large.data(), channels::kMaxMessageBytes, at_ms(0));
  CHECK(read_all(queue).size() == 1);
  put(queue, 1);
  queue.set_enabled(false);
  put(queue, 2);
  queue.set_enabled(true);
  put(queue, 3);
  CHECK(read_all(queue) == std::vector{3});
}

TEST_CASE("A raw queue can be opened while the bus runs") {
  Bus bus(Identity::fresh("raw_queue_test", 1), {.memory = true});
  bus.drain(at_ms(0));
  RawQueue& queue = bus.raw(channels::kMediaClock, 8);
  media_clock_t m{};
  m.header.sim_time_ns = -1, m.medium = "video.mp4", m.index = 5, m.host_time_ns = 9;
  REQUIRE(bus.publish(channels::kMediaClock, m));
  bus.drain(at_ms(1));
  int messages = 0;
  queue.read([&](std::span<const std::uint8_t> bytes, HostTime) {
    const auto back = decode<media_clock_t>(bytes.data(), bytes.size());
    REQUIRE(back);
    CHECK(back->index == 5);
    ++messages;
  });
  CHECK(messages == 1);
}
