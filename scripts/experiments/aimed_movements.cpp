// Aimed movements of one person: with a late picture (observer/pointing.h), and to a plate that is also felt.
#include <algorithm>
#include <cmath>
#include <deque>
#include <string>

#include "scripts/experiments/paradigms.h"
#include "scripts/simulated_player/observer/impedance_arm.h"
#include "scripts/simulated_player/observer/pointing.h"

namespace tactus::experiments {
namespace {

constexpr double kTapStep_s = 0.001, kTapLimit_s = 2;
constexpr double kTapHeight_m = 0.01, kTapPush_N = 2;  // design: the last centimetre to the plate
constexpr double kPlate_N_m = 500;                     // design: a plate that a desktop device renders

observer::PointingTrial aimed(Participant& p, double lag_s, double distance_m, double difficulty_bit,
                              std::uint64_t number) {
  const std::string key = "pointing " + std::to_string(lag_s) + " " + std::to_string(distance_m);
  auto& session = p.prepared<observer::PointingSession>(key, [&] {
    return observer::PointingSession(p.player(), {.delay_s = lag_s, .distance_m = distance_m},
                                     p.trial_seed("pointing", 0));
  });
  return session.trial(observer::target_width_m(distance_m, difficulty_bit), number);
}

// Time from the end of an aimed movement over the plate to the start of the next one: the hand falls, and the
// participant turns when the contact is felt or seen, the earlier of both.
double contact_phase_s(Participant& p, double visual_s, double force_s, std::uint64_t seed) {
  const auto& player = p.player();
  observer::ImpedanceArm arm(player, Eigen::Vector3d(0, 0, kTapHeight_m), seed);
  std::deque<double> late(static_cast<std::size_t>(std::lround(force_s / kTapStep_s)), 0.0);
  double noticed_s = kTapLimit_s;
  for (int i = 0; i * kTapStep_s < noticed_s; ++i) {
    const double now_s = i * kTapStep_s, depth_m = -arm.position_m().z();
    late.push_back(depth_m > 0 ? kPlate_N_m * depth_m : 0);
    const double force_N = late.front();
    late.pop_front();
    if (force_N > player.force_floor_N) noticed_s = std::min(noticed_s, now_s + player.touch_latency_s);
    if (depth_m > 0) noticed_s = std::min(noticed_s, now_s + visual_s + player.visual_latency_s);
    arm.step(Eigen::Vector3d(0, 0, -kTapPush_N), Eigen::Vector3d(0, 0, force_N), kTapStep_s);
  }
  return noticed_s + player.muscle_s;
}

}  // namespace

// Settings: lag_ms of the picture, difficulty_bit, distance_m. Answers time_s, and miss: 0 or 1.
Outcome pointing(Participant& p, const TrialSettings& s, std::uint64_t number) {
  const auto trial = aimed(p, s.number("lag_ms", 0, 1000) * 1e-3, s.number_or("distance_m", 0.2, 0.02, 1),
                           s.number("difficulty_bit", 0.5, 8), number);
  return {{"time_s", trial.time_s}, {"miss", !trial.hit}};
}

// Settings: visual_ms, force_ms: delays of picture and force; difficulty_bit, distance_m. Answers time_s from
// plate to plate, and miss.
Outcome tapping(Participant& p, const TrialSettings& s, std::uint64_t number) {
  const double visual_s = s.number_or("visual_ms", 0, 0, 1000) * 1e-3,
               force_s = s.number_or("force_ms", 0, 0, 1000) * 1e-3;
  const auto trial =
      aimed(p, visual_s, s.number_or("distance_m", 0.1, 0.02, 1), s.number("difficulty_bit", 0.5, 8), number);
  return {{"time_s", trial.time_s + contact_phase_s(p, visual_s, force_s, p.trial_seed("tapping", number))},
          {"miss", !trial.hit}};
}

}  // namespace tactus::experiments
