#include "scripts/simulated_player/observer/checks/expected.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scripts/simulated_player/observer/population.h"

namespace tactus::observer {

TEST_CASE("For the typical player the laws expect values in the published bands") {
  const ExpectedPointing pointing = expected_pointing({});
  CHECK(1 / pointing.slope_s_bit > 3.5);
  CHECK(1 / pointing.slope_s_bit < 4.9);
  CHECK(pointing.growth == Approx(1.03).epsilon(0.1));  // MacKenzie and Ware 1993
  CHECK(pointing.errors > 2);
  CHECK(pointing.errors < 4.5);
  CHECK(expected_response_s({}, Disturbance::kPush) == Approx(0.065 + 0.2147 * 0.04));
  CHECK(expected_response_s({}, Disturbance::kJump) == Approx(0.120 + 0.2147 * 0.04));
  CHECK(expected_recalibration_s({}) == Approx(0.02).epsilon(0.15));  // Sugano et al. 2012: about 20 ms
  CHECK(expected_peak_deg({}) > 5);
  CHECK(expected_peak_deg({}) < 15);
}

TEST_CASE("A player who learns more of a delay is expected to lose less by it") {
  PlayerParameters learns;
  learns.motor_adaptation = 0.775;  // the rest is half of that of the typical player
  const ExpectedPointing half = expected_pointing(learns), whole = expected_pointing({});
  CHECK(half.growth == Approx(whole.growth / 2).epsilon(0.25));
  CHECK(half.added_time < 0.7 * whole.added_time);
  CHECK(half.slope_s_bit == Approx(whole.slope_s_bit).epsilon(0.01));
}

TEST_CASE("A slow player is expected to be slow, and to lose a smaller share of her time by a delay") {
  PlayerParameters slow;
  slow.pace_s_bit = 0.3;
  CHECK(expected_pointing(slow).slope_s_bit > 1.3 * expected_pointing({}).slope_s_bit);
  CHECK(expected_pointing(slow).added_time < 0.8 * expected_pointing({}).added_time);
}

TEST_CASE("A cautious player is expected to be slower and more exact at every delay and difficulty") {
  PlayerParameters cautious, careless;
  cautious.caution = 3, careless.caution = 0.5;
  for (double delay_s : kPointingDelays_s)
    for (double difficulty : kDifficulties_bit) {
      CAPTURE(delay_s, difficulty);
      const ExpectedTrial slow = expected_trial(cautious, delay_s, difficulty), quick = expected_trial(careless, delay_s, difficulty);
      CHECK(slow.time_s >= quick.time_s);
      CHECK(slow.errors <= quick.errors);
    }
}

TEST_CASE("A player with exact ears is expected to be moved by a picture over smaller disparities") {
  PlayerParameters exact, inexact;
  exact.azimuth_sd_deg = 2, inexact.azimuth_sd_deg = 8;
  CHECK(expected_peak_deg(exact) < expected_peak_deg({}));
  CHECK(expected_peak_deg({}) < expected_peak_deg(inexact));
}

TEST_CASE("The mean of a population by the laws lies in the published bands of groups") {
  constexpr int kPlayers = 128;
  double throughput_bit_s = 0, growth = 0, shift_ms = 0, push_ms = 0, jump_ms = 0;
  for (std::uint32_t i = 0; i < kPlayers; ++i) {
    const PlayerParameters player = player_of(i, 1);
    const ExpectedPointing pointing = expected_pointing(player);
    throughput_bit_s += 1 / pointing.slope_s_bit / kPlayers, growth += pointing.growth / kPlayers;
    shift_ms += 1e3 * expected_recalibration_s(player) / kPlayers;
    push_ms += 1e3 * expected_response_s(player, Disturbance::kPush) / kPlayers;
    jump_ms += 1e3 * expected_response_s(player, Disturbance::kJump) / kPlayers;
  }
  const auto within = [](double value, double low, double high) {
    CHECK(value > low);
    CHECK(value < high);
  };
  within(throughput_bit_s, 3.5, 6);
  within(growth, 0.6, 1.4);
  within(shift_ms, 10, 35);
  within(push_ms, 50, 90);
  within(jump_ms, 100, 170);
}

}  // namespace tactus::observer
