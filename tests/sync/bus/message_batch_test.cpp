// Tests of the bound and order of a message batch.
#include "sync/bus/message_batch.h"

#include <catch2/catch.hpp>

using namespace tactus::sync;

TEST_CASE("A batch rejects messages beyond its limit and keeps the rest in order") {
  constexpr HostTime kStart{};
  const auto bytes = [](std::size_t n) { return std::vector<std::uint8_t>(n, 7); };
  // Overhead of a message beside its bytes.
  MessageBatch one;
  REQUIRE(one.add(kStart, {"A", bytes(50)}, 1000));
  const std::size_t beside = one.bytes() - 51, kMax = 100 + 2 * beside;
  CHECK(beside > 0);
  MessageBatch batch;
  CHECK(batch.add(kStart, {"A", bytes(50)}, kMax));
  CHECK_FALSE(batch.add(kStart, {"A", bytes(60)}, kMax));
  CHECK(batch.add(kStart + Nanoseconds(1), {"BB", bytes(47), false}, kMax));
  REQUIRE(batch.size() == 2);
  CHECK(batch.bytes() == kMax);
  CHECK(batch[0].channel == "A");
  CHECK(batch[0].data.size() == 50);
  CHECK(batch[0].complete);
  CHECK(batch[1].channel == "BB");
  CHECK(batch[1].data.size() == 47);
  CHECK_FALSE(batch[1].complete);
  CHECK(batch[1].arrival == kStart + Nanoseconds(1));
  batch.clear();
  CHECK(batch.size() == 0);
  CHECK(batch.bytes() == 0);
}
