#include "scripts/simulated_player/observer/checks/expected.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "scripts/simulated_player/observer/checks/line_fit.h"
#include "scripts/simulated_player/observer/cue_combination.h"
#include "scripts/simulated_player/observer/delay_belief.h"
#include "scripts/simulated_player/observer/pointing.h"
#include "scripts/simulated_player/observer/population.h"

namespace tactus::observer {
namespace {

constexpr double kIntercept_s = 0.23, kGrowth = 1.03;  // MacKenzie and Ware 1993
constexpr double kSearchStep_s = 0.001;
constexpr double kMuscleOnset = 0.2147;  // x of 1 - (1 + x) exp(-x) = 0.02

// The nearest player of the published ranges: the laws move a band for people, not for a player that is none.
PlayerParameters nearest_person(PlayerParameters player) {
  for (const ParameterRange& range : parameter_ranges())
    player.*range.field = std::clamp(player.*range.field, range.to_si * range.low, range.to_si * range.high);
  return player;
}

// After the exposure of an experiment, without the noise of judgements.
DelayBelief belief_of(const PlayerParameters& player, double delay_s) {
  DelayBelief belief({player.visual_latency_s, player.initial_delay_error_s, player.adaptation_rate,
                      player.motor_adaptation});
  for (int i = 0; i < PointingDef{}.exposure; ++i) belief.observe(player.visual_latency_s + delay_s, 0);
  return belief;
}

// As expected_trial, for this unlearnt delay, believed age of a picture, and scatter of a hand at rest.
ExpectedTrial trial_by_law(const PlayerParameters& player, double unlearnt_s, double age_s, double settled_m,
                           double difficulty_bit) {
  const double slope_s_bit = player.pace_s_bit + kGrowth / (1 - PlayerParameters{}.motor_adaptation) * unlearnt_s;
  const double constant_s = slope_s_bit / std::numbers::ln2;
  const double distance_m = PointingDef{}.distance_m, width_m = target_width_m(distance_m, difficulty_bit);
  for (double t = constant_s * std::log(2 * distance_m / width_m);; t += kSearchStep_s) {
    const double place = distance_m * std::exp(-t / constant_s), speed = place / constant_s;
    const double sd = std::sqrt(settled_m * settled_m + player.process_noise_m2_s * speed * age_s +
                                speed * speed * unlearnt_s * unlearnt_s);
    const double now = miss_probability(place, sd, width_m),
                 then = miss_probability(place * std::exp(-kConsidered_s / constant_s), sd, width_m);
    if (error_cost_s(player) * (now - then) <= kConsidered_s) return {t, now};
  }
}

}  // namespace

ExpectedTrial expected_trial(const PlayerParameters& player, double delay_s, double difficulty_bit) {
  const DelayBelief belief = belief_of(player, delay_s);
  return trial_by_law(player, std::abs(belief.noticed_s()), belief.believed_s(),
                      settled_sd_m(player, belief.believed_s()), difficulty_bit);
}

ExpectedPointing expected_pointing(const PlayerParameters& measured) {
  const PlayerParameters player = nearest_person(measured);
  std::vector<double> slopes, means, errors;
  for (double delay_s : kPointingDelays_s) {
    const DelayBelief belief = belief_of(player, delay_s);
    const double settled_m = settled_sd_m(player, belief.believed_s());
    std::vector<double> times;
    double missed = 0;
    for (double difficulty : kDifficulties_bit) {
      const ExpectedTrial trial =
          trial_by_law(player, std::abs(belief.noticed_s()), belief.believed_s(), settled_m, difficulty);
      times.push_back(trial.time_s), missed += trial.errors / static_cast<double>(kDifficulties_bit.size());
    }
    const Line line = fit_line(kDifficulties_bit, times);
    slopes.push_back(line.slope), means.push_back(kIntercept_s + line.intercept + 4 * line.slope);
    errors.push_back(missed);
  }
  return {slopes.front(), fit_line(kPointingDelays_s, slopes).slope, means.back() / means.front() - 1,
          errors.back() / errors.front()};
}

double expected_response_s(const PlayerParameters& measured, Disturbance disturbance) {
  const PlayerParameters player = nearest_person(measured);
  const bool push = disturbance == Disturbance::kPush;
  return (push ? player.touch_latency_s : player.visual_latency_s) + kMuscleOnset * player.muscle_s;
}

double expected_scatter_ratio(const PlayerParameters& measured) {
  return nearest_person(measured).motor_noise_share / PlayerParameters{}.motor_noise_share;
}

double expected_peak_deg(const PlayerParameters& measured) {
  const PlayerParameters player = nearest_person(measured);
  const double va = player.azimuth_sd_deg * player.azimuth_sd_deg, vv = player.visual_sd_deg * player.visual_sd_deg;
  const double vp = kPlacesOfCauses_deg * kPlacesOfCauses_deg;
  double largest = 0, peak = 0;
  for (double disparity = 0.1; disparity <= 30; disparity += 0.1) {
    const double alone = -disparity / 2 / va / (1 / va + 1 / vp);
    const double shift = infer_cause({-disparity / 2, va}, {disparity / 2, vv}, vp, player.common_cause).a - alone;
    if (shift > largest) largest = shift, peak = disparity;
  }
  return peak;
}

double expected_recalibration_s(const PlayerParameters& measured) {
  const PlayerParameters player = nearest_person(measured);
  constexpr int kTaps = 60;
  constexpr double kAdded_s = 0.1;
  DelayBelief belief({player.touch_latency_s, 0, player.adaptation_rate, player.perceptual_adaptation});
  for (int i = 0; i < kTaps; ++i) belief.observe(player.touch_latency_s + kAdded_s, 0);
  return belief.believed_s() - player.touch_latency_s;
}

}  // namespace tactus::observer
