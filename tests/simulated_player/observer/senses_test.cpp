// Vision, touch, hearing, reaction times and the fit of a threshold.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "scripts/simulated_player/observer/checks/psychometric.h"
#include "scripts/simulated_player/observer/hearing.h"
#include "scripts/simulated_player/observer/reaction.h"
#include "scripts/simulated_player/observer/touch.h"
#include "scripts/simulated_player/observer/vision.h"

namespace tactus::observer {

TEST_CASE("A heat flow that differs by 43 % at 75 % correct has a standard deviation of 45 %") {
  CHECK(weber_sd(0.43) == Approx(0.451).margin(5e-4));
}

TEST_CASE("The direction noise of vision doubles at E2, and the noise of a gap grows with the gap") {
  PlayerParameters player;
  const double at_gaze = seen_sd_m(player, 0.6, 0);
  CHECK(at_gaze == Approx(0.6 * std::tan(0.12 * std::numbers::pi / 180)));
  CHECK(seen_sd_m(player, 0.6, 0.6 * std::tan(player.visual_e2_deg * std::numbers::pi / 180)) ==
        Approx(2 * at_gaze));
  CHECK(seen_gap_sd_m(player, 0.6, 0) < at_gaze);
  CHECK(seen_gap_sd_m(player, 0.6, 0.1) > seen_gap_sd_m(player, 0.6, 0.01));
}

TEST_CASE("An occluded thing is never noticed, and a large one in full contrast nearly always") {
  CHECK(detection_probability(0, 1) == 0);
  CHECK(detection_probability(100, 0) == 0);
  CHECK(detection_probability(4, 1) == Approx(0.5).margin(0.01));
  CHECK(detection_probability(1000, 1) > 0.99);
}

TEST_CASE("A force below the floor is not felt") {
  PlayerParameters player;
  NoiseStream noise(1, 1);
  CHECK_FALSE(felt_force_N(player, {0.9 * player.force_floor_N, 0, 0}, noise));
  CHECK(felt_force_N(player, {2 * player.force_floor_N, 0, 0}, noise));
  CHECK_FALSE(felt_force_N(player, {std::nan(""), 0, 0}, noise));
}

TEST_CASE("The vibration threshold equals the values of the MPEG reference model") {
  const double rows[][2]{{0, -15.000},   {40, -37.962}, {100, -59.886}, {250, -77.000},
                         {500, -53.308}, {800, 4.078},  {1000, 47.868}};
  for (const auto& row : rows) CHECK(vibration_threshold_dB(row[0]) == Approx(row[1]).margin(5e-4));
}

TEST_CASE("A sound at the side is heard less exactly, and confusions mirror it to the back") {
  PlayerParameters player;
  CHECK(azimuth_sd_deg(player, 90) == Approx(2.6 * azimuth_sd_deg(player, 0)));
  player.front_back_confusion = 0.25;
  NoiseStream noise(2, 1);
  int behind = 0;
  constexpr int kSounds = 4000;
  for (int i = 0; i < kSounds; ++i) behind += std::abs(heard_place(player, {}, noise).azimuth_deg) > 90;
  CHECK(behind / double{kSounds} == Approx(0.25).margin(3 * std::sqrt(0.25 * 0.75 / kSounds)));
}

TEST_CASE("Near sounds seem farther and far sounds nearer") {
  PlayerParameters player;
  player.distance_weber = 0;
  NoiseStream noise(3, 1);
  CHECK(heard_place(player, {0, 0, 0.3}, noise).distance_m > 0.3);
  CHECK(heard_place(player, {0, 0, 5}, noise).distance_m < 5);
}

TEST_CASE("The typical visual reaction takes 213 ms with a standard deviation of 36 ms") {
  const PlayerParameters player;
  CHECK(mean_reaction_s(player, Stimulus::kVision) == Approx(0.213));
  NoiseStream noise(4, 1);
  double sum = 0, square = 0;
  constexpr int kTimes = 20000;
  for (int i = 0; i < kTimes; ++i) {
    const double t = simple_reaction_s(player, Stimulus::kVision, noise);
    sum += t / kTimes, square += t * t / kTimes;
  }
  // Decisions below 0 are cut, which adds less than 1 ms.
  CHECK(sum == Approx(0.213).margin(0.002));
  CHECK(std::sqrt(square - sum * sum) == Approx(0.036).margin(0.002));
  CHECK(choice_time_s(1) == 0);
  CHECK(choice_time_s(4) == Approx(0.3));
}

TEST_CASE("The fit of answers finds the normal distribution that they come from") {
  NoiseStream noise(5, 1);
  std::vector<Level> levels;
  for (double x = -3; x <= 5; x += 1) {
    Level level{x, 0, 4000};
    for (int i = 0; i < 4000; ++i) level.yes += noise.normal(1.5) + 0.7 < x;
    levels.push_back(level);
  }
  const NormalFit fit = fit_normal(levels);
  CHECK(fit.mean == Approx(0.7).margin(0.05));
  CHECK(fit.sd == Approx(1.5).epsilon(0.04));
  CHECK(std::isinf(fit_normal({}).sd));
  CHECK(std::isinf(fit_normal({{0, 9, 10}, {1, 1, 10}}).sd));
}

}  // namespace tactus::observer
