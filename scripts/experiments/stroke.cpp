// Sinusoidal strokes through a damper, a spring or a damped mass whose force is late: Rank, Shi, Mueller and
// Hirche 2010. The arm is in a closed loop with the late force. The participant compares the felt force with the
// movement: their ratio and their phase. Both have the noise of the senses; the prediction is learnt without
// delay.
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "scripts/experiments/guided_arm.h"
#include "scripts/experiments/paradigms.h"
#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/vision.h"

namespace tactus::experiments {
namespace {

constexpr double kStrokeStep_s = 0.001;
constexpr int kFirstCycles = 1, kFeltCycles = 2;
constexpr int kLooks = 2 * kFeltCycles;  // design: each reversal shows the lag of the force once

struct Environment {
  double stiffness_N_m = 0, damping_N_s_m = 0, mass_kg = 0;
};

struct Stroke {
  std::complex<double> ratio;       // of force and place at the frequency of the movement, N/m
  double force_N = 0, place_m = 0;  // amplitudes
};

Stroke move(const observer::PlayerParameters& player, const Environment& e, double delay_s, double amplitude_m,
            double frequency_Hz) {
  GuidedArm arm(player);
  // The force of a step acts in the next one.
  LateValue late(static_cast<std::size_t>(std::lround(delay_s / kStrokeStep_s)));
  const double w = 2 * std::numbers::pi * frequency_Hz;
  const int cycle = static_cast<int>(std::lround(1 / (frequency_Hz * kStrokeStep_s)));
  std::complex<double> place = 0, force = 0;
  double force_N = 0;
  for (int i = 0; i < (kFirstCycles + kFeltCycles) * cycle; ++i) {
    const double t = i * kStrokeStep_s;
    arm.step(amplitude_m * std::sin(w * t), amplitude_m * w * std::cos(w * t), force_N, kStrokeStep_s);
    force_N = late.pass(-e.stiffness_N_m * arm.place_m() - e.damping_N_s_m * arm.speed_m_s() -
                        e.mass_kg * arm.acceleration_m_s2());
    if (i < kFirstCycles * cycle) continue;
    const std::complex<double> phase = std::polar(1.0, -w * t);
    place += phase * arm.place_m();
    force -= phase * force_N;  // the force that the hand exerts
  }
  const double scale = 2.0 / (kFeltCycles * cycle);
  return {force / place, scale * std::abs(force), scale * std::abs(place)};
}

// Squared distance of a stroke, as perceived, from the learnt one, in units of the noise; 0: no force is felt.
double mismatch(const Participant& p, const Stroke& real, const Stroke& learnt, double frequency_Hz,
                observer::NoiseStream& noise) {
  const auto& player = p.player();
  const double w = 2 * std::numbers::pi * frequency_Hz;
  const double place_sd = player.proprioceptive_sd_m / (std::sqrt(static_cast<double>(kLooks)) * real.place_m);
  const double gain_sd = std::max(1e-9, std::hypot(observer::weber_sd(player.force_weber), place_sd)),
               phase_sd =
                   std::max(1e-9, std::hypot(w * p.timing().touch_sd_s / std::sqrt(1.0 * kLooks), place_sd));
  const std::complex<double> change = std::log(real.ratio / learnt.ratio);
  const double gain = (change.real() + noise.normal(gain_sd)) / gain_sd,
               phase = (change.imag() + noise.normal(phase_sd)) / phase_sd;
  if (real.force_N < player.force_floor_N) return 0;
  return gain * gain + phase * phase;
}

Environment environment(const TrialSettings& s) {
  const std::string kind = s.word("environment", {"damper", "spring", "inertia"});
  const double stiffness = s.number_or("stiffness_N_m", 100, 1, 2000),
               damping = s.number_or("damping_N_s_m", 10, 0.1, 200),
               mass = s.number_or("mass_kg", 0.5, 0.01, 0.69), loss = s.number_or("mass_damping_N_s_m", 2, 0, 50);
  if (kind == "damper") return {0, damping, 0};
  if (kind == "spring") return {stiffness, 0, 0};
  return {0, loss, mass};
}

}  // namespace

// Settings: environment with stiffness_N_m, damping_N_s_m, or mass_kg and mass_damping_N_s_m; delay_ms of the
// force; amplitude_m, frequency_Hz. Answers `right`: the late one of two strokes was recognised.
Outcome stroke(Participant& p, const TrialSettings& s, std::uint64_t number) {
  const Environment e = environment(s);
  const double delay_s = s.number("delay_ms", 0, 500) * 1e-3,
               amplitude_m = s.number_or("amplitude_m", 0.1, 0.01, 0.5),
               frequency_Hz = s.number_or("frequency_Hz", 1, 0.1, 5);
  observer::NoiseStream noise(p.trial_seed("stroke", number), 1);
  const bool attended = noise.uniform() >= p.player().lapse, guess = noise.uniform() < 0.5;
  const auto made = [&](double late_s, double by) {
    return move(p.player(), e, late_s, amplitude_m * by, frequency_Hz);
  };
  const std::string key = "stroke " + std::to_string(e.stiffness_N_m) + " " + std::to_string(e.damping_N_s_m) +
                          " " + std::to_string(e.mass_kg) + " " + std::to_string(amplitude_m) + " " +
                          std::to_string(frequency_Hz);
  const Stroke& learnt = p.prepared<Stroke>(key, [&] { return made(0, 1); });
  // The amplitude of the own movement varies.
  const double first = std::max(0.1, 1 + noise.normal(p.player().motor_noise_share)),
               second = std::max(0.1, 1 + noise.normal(p.player().motor_noise_share));
  const double late = mismatch(p, made(delay_s, first), learnt, frequency_Hz, noise),
               plain = mismatch(p, made(0, second), learnt, frequency_Hz, noise);
  return {{"right", attended && late != plain ? late > plain : guess}};
}

}  // namespace tactus::experiments
