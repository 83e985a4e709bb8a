// Tests of the twelve checks of the simulated player.
#include "scripts/simulated_player/observer/checks/checks.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace tactus::observer {
namespace {

constexpr std::uint64_t kSeed = 1;

void require_passed(const std::vector<CheckResult>& results) {
  REQUIRE_FALSE(results.empty());
  for (const CheckResult& r : results) {
    INFO(r.check << " " << r.quantity << ": " << r.value << " " << r.unit << ", published " << r.published << " ("
                 << r.source << ")");
    CHECK(r.value >= r.low);
    CHECK(r.value <= r.high);
  }
}

bool failed(const std::vector<CheckResult>& results) {
  return std::any_of(results.begin(), results.end(), [](const CheckResult& r) { return !r.passed(); });
}

}  // namespace

TEST_CASE(
    "The typical player points with the throughput of people, and delays multiply with difficulty as in MacKenzie "
    "and Ware 1993") {
  require_passed(check_pointing({}, kSeed, {}));  // checks 1 to 3
}

TEST_CASE("The typical player corrects a push and a jump of the picture as early as people") {
  require_passed(run_check(4, {}, kSeed));
}

TEST_CASE("The typical player ends a reach of 10 cm in 0.5 s within 3 to 8 mm") {
  require_passed(run_check(5, {}, kSeed));
}

TEST_CASE("The typical player combines sight and touch of a size as in Ernst and Banks 2002") {
  require_passed(run_check(6, {}, kSeed));
}

TEST_CASE("The picture shifts a sound most at 5 to 15 degrees, as in Koerding et al. 2007") {
  require_passed(run_check(7, {}, kSeed));
}

TEST_CASE("The typical player has the thresholds of people through its own percepts") {
  require_passed(run_check(8, {}, kSeed));
}

TEST_CASE("Sixty late taps shift simultaneity as in Sugano et al. 2012") {
  require_passed(run_check(9, {}, kSeed));
}

TEST_CASE("Jitter up to 67 ms costs little time, and a delay of that size more") {
  require_passed(run_check(10, {}, kSeed));
}

TEST_CASE("Without reckoning by the believed delay the limit falls") { require_passed(run_check(11, {}, kSeed)); }

TEST_CASE("An endless delay equals a removed sense") { require_passed(run_check(12, {}, kSeed)); }

TEST_CASE("A player that is not like people fails the check of that property") {
  PlayerParameters player;
  player.touch_latency_s = 0.2;
  CHECK(failed(run_check(4, player, kSeed)));
  player = {};
  player.motor_noise_share = 0.6;
  CHECK(failed(run_check(5, player, kSeed)));
  player = {};
  player.azimuth_sd_deg = 20;
  CHECK(failed(run_check(7, player, kSeed)));
  player = {};
  player.force_weber = 0.4;
  CHECK(failed(run_check(8, player, kSeed)));
  player = {};
  player.perceptual_adaptation = 0;
  CHECK(failed(run_check(9, player, kSeed)));
  player = {};
  player.pace_s_bit = 0.05;
  CHECK(failed(check_pointing(player, kSeed, {.share = 0.1})));
}

TEST_CASE("A person is compared with the law for her own latencies, ears and adaptation, not with the mean of a group") {
  PlayerParameters player;
  player.visual_latency_s = 0.165, player.touch_latency_s = 0.088;
  CHECK_FALSE(failed(run_check(4, player, kSeed)));
  player = {};
  player.motor_noise_share = 0.04;
  CHECK_FALSE(failed(run_check(5, player, kSeed)));
  player = {};
  player.azimuth_sd_deg = 2.2;
  CHECK_FALSE(failed(run_check(7, player, kSeed)));
  player = {};
  player.perceptual_adaptation = 0.11, player.adaptation_rate = 0.025;
  CHECK_FALSE(failed(run_check(9, player, kSeed)));
}

TEST_CASE("A player that fails a check is refused with the number of the check") {
  PlayerParameters player;
  player.touch_latency_s = 0.2;
  CHECK(failing_checks(player, kSeed, true) == std::vector<int>{4});
  CHECK_THROWS_AS(require_admitted(player, kSeed), std::runtime_error);
  CHECK_THROWS_AS(run_check(13, player, kSeed), std::invalid_argument);
}

TEST_CASE("A value that is not a number fails its check") {
  CheckResult result;
  result.value = std::nan("");
  result.high = 1;
  CHECK_FALSE(result.passed());
}

}  // namespace tactus::observer
