// Tests of the numbers of requests that replace each other.
#include "lcmtypes/generation.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <random>
#include <tactus/degradation_t.hpp>
#include <tactus/playout_request_t.hpp>
#include <tactus/playout_t.hpp>

#include "sync/bus/decode.h"
#include "tests/lcmtypes/samples.h"

namespace tactus::test {

TEST_CASE("A new request has a larger number than any known one, however the clocks differ") {
  CHECK(next_generation(-1, 5) == 5);
  CHECK(next_generation(0, 5) == 5);
  CHECK(next_generation(5, 5) == 6);
  CHECK(next_generation(kMaxGeneration, 5) == kMaxGeneration);
  CHECK(next_generation(INT64_MAX, INT64_MAX) == kMaxGeneration);
  CHECK(next_generation(-1, INT64_MIN) == 0);
  std::mt19937_64 random(1);
  for (int i = 0; i < 10'000; ++i) {
    const auto newest = static_cast<std::int64_t>(random() >> (2 + random() % 62)), now = static_cast<std::int64_t>(random() >> (2 + random() % 62));
    const std::int64_t next = next_generation(newest, now);
    CHECK((next > newest && next >= now && next <= kMaxGeneration));
  }
}

TEMPLATE_TEST_CASE("A request that no later one could replace is refused", "", degradation_t, playout_t, playout_request_t) {
  Samples samples(5);
  TestType m{};
  samples.fill(m);
  const auto accepted = [&](std::int64_t generation) {
    m.generation = generation;
    const auto bytes = sync::encode(m);
    return sync::decode_asset<TestType>(bytes).has_value();
  };
  CHECK(accepted(0));
  CHECK(accepted(kMaxGeneration));
  for (const std::int64_t wrong : {std::int64_t{-1}, kMaxGeneration + 1, INT64_MAX}) CHECK_FALSE(accepted(wrong));
}

}  // namespace tactus::test
