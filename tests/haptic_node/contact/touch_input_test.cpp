#include "haptic_node/contact/touch_input.h"

#include <catch2/catch.hpp>
#include <tactus/touch_model_t.hpp>

#include "tests/haptic_node/support/tick.h"

using namespace tactus;
using namespace tactus::haptic;
using tactus::haptic::test::kMs;

namespace {

touch_model_t model_at(std::int64_t ms) {
  touch_model_t m{};
  m.header.run_id = 1;
  m.header.incarnation = 5;
  m.header.sim_time_ns = ms * kMs;
  m.header.publish_time_ns = ms * kMs;
  m.clock = {ms * kMs, ms * kMs, 1};
  return m;
}

}  // namespace

TEST_CASE("A touch model far in the future does not block later touch models") {
  TouchInput input(0, 1);
  SECTION("A model with the current clock is ignored") {
    input.push(model_at(1), sync::host_time(kMs));
    REQUIRE(input.pop());
    touch_model_t forged = model_at(2);
    forged.header.sim_time_ns = 3'600'000 * kMs;
    input.push(forged, sync::host_time(2 * kMs));
    CHECK_FALSE(input.pop());
    input.push(model_at(3), sync::host_time(3 * kMs));
    CHECK(input.pop());
  }
  SECTION("A first model with a matching clock is replaced within 0.3 s") {
    touch_model_t forged = model_at(3'600'000);
    forged.header.publish_time_ns = forged.clock.host_ns = 0;
    input.push(forged, sync::host_time(0));
    REQUIRE(input.pop());
    for (int ms = 1; ms <= 302; ++ms) input.push(model_at(ms), sync::host_time(ms * kMs));
    REQUIRE(input.pop());
  }
}
