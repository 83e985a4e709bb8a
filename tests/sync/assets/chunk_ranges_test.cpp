#include "sync/assets/chunk_ranges.h"

#include <catch2/catch.hpp>
#include <random>
#include <set>

using namespace tactus::sync;

TEST_CASE("Requested chunks are returned once each, in order, and again after another request") {
  ChunkRanges ranges;
  CHECK_FALSE(ranges.take());
  ranges.add(4, 7);
  ranges.add(2, 5);
  ranges.add(9, 10);
  CHECK(ranges.ranges() == 2);
  for (const std::size_t chunk : {2u, 3u, 4u, 5u, 6u, 9u}) CHECK(ranges.take() == chunk);
  CHECK(ranges.empty());
  ranges.add(3, 3);
  CHECK(ranges.empty());
  ranges.add(3, 4);
  CHECK(ranges.take() == 3u);
}

TEST_CASE("Every requested chunk is returned for any requests, and the number of ranges is bounded") {
  std::mt19937 random(2);
  for (int round = 0; round < 200; ++round) {
    ChunkRanges ranges;
    std::set<std::size_t> wanted;
    for (int i = 0; i < 300; ++i) {
      const std::size_t first = random() % 5000, end = first + 1 + random() % (round % 2 ? 3 : 40);
      ranges.add(first, end);
      for (std::size_t chunk = first; chunk < end; ++chunk) wanted.insert(chunk);
      CHECK(ranges.ranges() <= ChunkRanges::kMaxRanges);
      for (int n = static_cast<int>(random() % 3); n > 0; --n)
        if (const auto chunk = ranges.take()) wanted.erase(*chunk);
    }
    for (int left = 10'000; left > 0 && !ranges.empty(); --left) wanted.erase(*ranges.take());
    CHECK(ranges.empty());
    CHECK(wanted.empty());
  }
}

TEST_CASE("A chunk is returned although others are requested again and again") {
  ChunkRanges ranges;
  ranges.add(3000, 3001);
  bool sent = false;
  for (int i = 0; i < 200 && !sent; ++i) {
    ranges.add(0, 100);
    sent = ranges.take() == 3000u;
  }
  CHECK(sent);
}
