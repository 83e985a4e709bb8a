// The stiffness of a pressed spring whose force or picture is late: Knoerlein, Di Luca and Harders 2009. The arm
// is in a closed loop with the late force. The participant relates the felt force to the displacement while
// pressing; the displacement is seen and felt, and both cues combine by their reliability.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scripts/experiments/guided_arm.h"
#include "scripts/experiments/paradigms.h"
#include "scripts/simulated_player/observer/cue_combination.h"
#include "scripts/simulated_player/observer/touch.h"
#include "scripts/simulated_player/observer/vision.h"

namespace tactus::experiments {
namespace {

constexpr double kPressStep_s = 0.001, kPressViewing_m = 0.6;

// Slope of force against displacement while the perceived displacement grows, N/m, without noise.
double loading_stiffness(const observer::PlayerParameters& player, double stiffness_N_m, double force_s,
                         double visual_s, double depth_m, double frequency_Hz) {
  const double seen_m = observer::seen_sd_m(player, kPressViewing_m, 0), felt_m = player.proprioceptive_sd_m;
  const double weight = seen_m * seen_m + felt_m * felt_m > 0
                            ? felt_m * felt_m / (seen_m * seen_m + felt_m * felt_m)
                            : 0.5;  // of sight: maximum likelihood
  GuidedArm arm(player);
  const auto steps = [](double s) { return static_cast<std::size_t>(std::lround(s / kPressStep_s)); };
  LateValue late_force(steps(force_s)), late_picture(steps(visual_s));
  const double w = 2 * std::numbers::pi * frequency_Hz;
  double force_N = 0, before_m = 0, work = 0, square = 0;
  for (int i = 0; i * kPressStep_s < 1 / frequency_Hz; ++i) {
    const double t = i * kPressStep_s;
    arm.step(depth_m / 2 * (1 - std::cos(w * t)), depth_m / 2 * w * std::sin(w * t), -force_N, kPressStep_s);
    const double depth = std::max(0.0, arm.place_m());
    force_N = late_force.pass(stiffness_N_m * depth);
    const double perceived = weight * late_picture.pass(depth) + (1 - weight) * depth;
    if (perceived > before_m) work += force_N * perceived, square += perceived * perceived;
    before_m = perceived;
  }
  return square > 0 ? work / square : 0;
}

}  // namespace

// Settings: force_ms, visual_ms: delays of the standard; standard_N_m; comparison_percent: stiffness of the
// comparison against the standard; depth_m, frequency_Hz of the press. Answers `stiffer`: the comparison felt
// stiffer.
Outcome press_spring(Participant& p, const TrialSettings& s, std::uint64_t number) {
  const double force_s = s.number_or("force_ms", 0, 0, 500) * 1e-3,
               visual_s = s.number_or("visual_ms", 0, 0, 500) * 1e-3,
               standard = s.number_or("standard_N_m", 100, 1, 2000),
               comparison = standard * (1 + s.number("comparison_percent", -95, 500) / 100),
               depth_m = s.number_or("depth_m", 0.02, 1e-3, 0.2),
               frequency_Hz = s.number_or("frequency_Hz", 1, 0.1, 5);
  observer::NoiseStream noise(p.trial_seed("press_spring", number), 1);
  const bool attended = noise.uniform() >= p.player().lapse, guess = noise.uniform() < 0.5;
  const double first = observer::felt_stiffness(
                   p.player(), loading_stiffness(p.player(), standard, force_s, visual_s, depth_m, frequency_Hz),
                   noise),
               second = observer::felt_stiffness(
                   p.player(), loading_stiffness(p.player(), comparison, 0, 0, depth_m, frequency_Hz), noise);
  return {{"stiffer", attended && first != second ? second > first : guess}};
}

}  // namespace tactus::experiments
