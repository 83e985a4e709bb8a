// Tests of the queue between the probe thread and the node, and of the emulated clock.
#include "sync/clock_sync/probe_thread.h"

#include <catch2/catch.hpp>
#include <thread>

using namespace tactus::sync;

TEST_CASE("Items leave the queue in order, and a full queue rejects the next one") {
  SpscQueue<int, 4> queue;
  CHECK_FALSE(queue.pop());
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 3; ++i) CHECK(queue.push(3 * round + i));
    CHECK_FALSE(queue.push(-1));
    for (int i = 0; i < 3; ++i) CHECK(queue.pop() == 3 * round + i);
    CHECK_FALSE(queue.pop());
  }
}

TEST_CASE("Items pass from one thread to another without loss") {
  constexpr int kItems = 20000;
  SpscQueue<int, 16> queue;
  std::thread producer([&] {
    for (int i = 0; i < kItems;)
      if (queue.push(i)) ++i;
      else std::this_thread::yield();
  });
  int next = 0;
  while (next < kItems) {
    if (const auto item = queue.pop()) {
      REQUIRE(*item == next);
      ++next;
    } else {
      std::this_thread::yield();
    }
  }
  producer.join();
}

TEST_CASE("The emulated clock follows the host clock unless drift or jump are set") {
  const HostTime t = host_time(10'000'000'000);
  CHECK(EmulatedClock{}.read(t) == t);
  const EmulatedClock clock{100e-6, Nanoseconds(-5), t, t + Nanoseconds(2'000'000)};
  CHECK(clock.read(t) == t);
  CHECK(clock.read(t + Nanoseconds(1'000'000)) == t + Nanoseconds(1'000'100));
  CHECK(clock.read(t + Nanoseconds(2'000'000)) == t + Nanoseconds(2'000'195));
}
