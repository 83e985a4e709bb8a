#include "audio_node/signal/spsc.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <random>
#include <thread>
#include <vector>

using tactus::audio::Spsc;

TEST_CASE("A bounded queue transfers all elements once and in order between two threads") {
  constexpr std::int64_t kCount = 200'000;
  Spsc<std::int64_t> queue(64);
  std::thread sender([&] {
    std::int64_t batch[7];
    for (std::int64_t next = 0; next < kCount;) {
      std::size_t n = 0;
      for (; n < 1 + static_cast<std::size_t>(next % 7) && next + static_cast<std::int64_t>(n) < kCount; ++n)
        batch[n] = next + static_cast<std::int64_t>(n);
      if (queue.push(batch, n))
        next += static_cast<std::int64_t>(n);
      else
        std::this_thread::yield();
    }
  });
  std::int64_t expected = 0, got[5];
  bool in_order = true;
  while (expected < kCount) {
    const std::size_t n = queue.pop(got, 5);
    if (n == 0) std::this_thread::yield();
    for (std::size_t i = 0; i < n; ++i) in_order &= got[i] == expected++;
  }
  sender.join();
  CHECK(in_order);
  CHECK(queue.pop(got, 5) == 0);
}

TEST_CASE("A full queue takes all of a batch or nothing") {
  Spsc<int> queue(4);
  const int three[] = {1, 2, 3};
  REQUIRE(queue.push(three, 3));
  CHECK_FALSE(queue.push(three, 2));
  CHECK(queue.room() == 1);
  CHECK(queue.push(4));
  int out[8];
  REQUIRE(queue.pop(out, 8) == 4);
  CHECK(out[3] == 4);
}
