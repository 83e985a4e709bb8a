// A press on a soft body whose force is sent only when it has changed by a share: the perceptual deadband of
// Hinterseer, Hirche, Chaudhuri, Steinbach and Buss 2008. The arm is in a closed loop with the sent force.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scripts/experiments/guided_arm.h"
#include "scripts/experiments/paradigms.h"
#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/vision.h"

namespace tactus::experiments {
namespace {

constexpr double kSendStep_s = 0.001;

struct SentForce {
  double largest_step = 0;  // of the displayed force, as a share of it
  double sent = 0;          // share of the samples
};

SentForce press(const observer::PlayerParameters& player, double share, double stiffness_N_m, double depth_m,
                double frequency_Hz, double duration_s, observer::NoiseStream& noise) {
  GuidedArm arm(player);
  const double w = 2 * std::numbers::pi * frequency_Hz,
               noise_N = player.motor_noise_N * std::sqrt(0.01 / kSendStep_s);
  double sent_N = 0, tremor_N = 0, excitation_N = 0;
  SentForce result;
  int samples = 0, packets = 0;
  for (int i = 0; i * kSendStep_s < duration_s; ++i) {
    const double t = i * kSendStep_s, intended = depth_m * (0.75 - 0.25 * std::cos(w * t));
    excitation_N += kSendStep_s / player.muscle_s * (noise.normal(noise_N) - excitation_N);
    tremor_N += kSendStep_s / player.muscle_s * (excitation_N - tremor_N);
    arm.step(intended, depth_m * 0.25 * w * std::sin(w * t), tremor_N - sent_N, kSendStep_s);
    const double force_N = stiffness_N_m * std::max(0.0, arm.place_m());
    ++samples;
    if (std::abs(force_N - sent_N) <= share * std::abs(sent_N)) continue;
    // The first contact is a step in every condition.
    if (t > 0.5 && sent_N > 0)
      result.largest_step = std::max(result.largest_step, std::abs(force_N - sent_N) / sent_N);
    sent_N = force_N;
    ++packets;
  }
  result.sent = static_cast<double>(packets) / samples;
  return result;
}

}  // namespace

// Settings: deadband_percent; stiffness_N_m, depth_m, frequency_Hz of the press; duration_s. Answers `right`: the
// reduced one of two presses was recognised by its steps of force; saved_percent: packets that were not sent.
Outcome deadband(Participant& p, const TrialSettings& s, std::uint64_t number) {
  const double share = s.number("deadband_percent", 0, 100) / 100,
               stiffness = s.number_or("stiffness_N_m", 300, 1, 3000),
               depth_m = s.number_or("depth_m", 0.01, 1e-3, 0.1),
               frequency_Hz = s.number_or("frequency_Hz", 0.5, 0.05, 5),
               duration_s = s.number_or("duration_s", 3, 1, 60);
  observer::NoiseStream noise(p.trial_seed("deadband", number), 1), other(p.trial_seed("deadband", number), 2);
  const bool attended = noise.uniform() >= p.player().lapse, guess = noise.uniform() < 0.5;
  const double sd = observer::weber_sd(p.player().force_weber);
  const SentForce reduced = press(p.player(), share, stiffness, depth_m, frequency_Hz, duration_s, noise),
                  full = press(p.player(), 0, stiffness, depth_m, frequency_Hz, duration_s, other);
  const double here = reduced.largest_step + noise.normal(sd), there = full.largest_step + other.normal(sd);
  return {{"right", attended && here != there ? here > there : guess},
          {"saved_percent", 100 * (1 - reduced.sent)}};
}

}  // namespace tactus::experiments
