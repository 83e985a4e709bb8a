// Wood, plastic or metal by the sound and the vibration of a bouncing ball: De Pra, Fontana and Jaervelaeinen
// 2020. A plate rings after the impact; the internal damping of its material and the damping of its support end
// the ringing. The participant perceives for how long it rings above the threshold of the sense, and its
// frequency, and chooses the most probable material.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "scripts/experiments/paradigms.h"
#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/touch.h"
#include "scripts/simulated_player/observer/vision.h"

namespace tactus::experiments {
namespace {

// Loss factors: Cremer, Heckl and Petersson 2005, Structure-Borne Sound (metal below 0.002, wood 0.01-0.02,
// plastics 0.02-0.08; unverified).
struct Material {
  const char* name;
  double loss_factor;
};
constexpr std::array kMaterials{Material{"wood", 0.015}, Material{"plastic", 0.04}, Material{"metal", 0.001}};
constexpr double kExemplarSpread = 0.35;  // of the logarithm of a loss factor within one material, design
constexpr double kLowest_Hz = 200, kHighest_Hz = 2000;  // lowest mode of a plate, design
constexpr double kLoudness_dB = 50;                     // sound above its threshold at the impact, design
constexpr double kVibration_dB = 30;       // vibration above the threshold at 250 Hz at the impact, design
constexpr double kNeper_dB = 8.685889638;  // of a factor e
// Weber fraction of a heard decay: 25-40 % are not heard (Jaervelaeinen and Tolonen 2001; unverified).
constexpr double kHeardDecayWeber = 0.32;

// Time for which a ringing of this time constant exceeds a threshold that lies `level_dB` below its start, s.
double audible_s(double time_constant_s, double level_dB) {
  return time_constant_s * std::max(0.0, level_dB) / kNeper_dB;
}

double time_constant_s(double loss_factor, double frequency_Hz, double support_s) {
  return 1 / (std::numbers::pi * frequency_Hz * loss_factor + 1 / support_s);
}

// One sense: how long the ringing lasts above its threshold, and the noise of that.
struct Ringing {
  double level_dB, onset_sd_s, weber;
  double sd_s(double duration_s) const {
    return std::max(1e-9, std::hypot(std::numbers::sqrt2 * onset_sd_s, observer::weber_sd(weber) * duration_s));
  }
};

// Logarithm of the probability of a perceived duration, if the plate is of this material.
double log_likelihood(const Ringing& sense, double perceived_s, const Material& material, double frequency_Hz,
                      double support_s) {
  const auto duration_s = [&](double factor) {
    return audible_s(time_constant_s(material.loss_factor * factor, frequency_Hz, support_s), sense.level_dB);
  };
  const double mean = duration_s(1),
               spread = (duration_s(std::exp(-kExemplarSpread)) - duration_s(std::exp(kExemplarSpread))) / 2;
  const double sd = std::hypot(sense.sd_s(mean), spread);
  return -0.5 * std::pow((perceived_s - mean) / sd, 2) - std::log(sd);
}

}  // namespace

// Settings: material; cues: both, sound or vibration; support_ms: time constant of the ringing by the support
// alone. Answers `right`.
Outcome impact_material(Participant& p, const TrialSettings& s, std::uint64_t number) {
  const std::string name = s.word("material", {"wood", "plastic", "metal"}),
                    cues = s.word("cues", {"both", "sound", "vibration"});
  const double support_s = s.number_or("support_ms", 100, 1, 10000) * 1e-3;
  observer::NoiseStream noise(p.trial_seed("impact_material", number), 1);
  const bool attended = noise.uniform() >= p.player().lapse;
  const auto guess = static_cast<std::size_t>(3 * noise.uniform());
  const double frequency_Hz = kLowest_Hz * std::pow(kHighest_Hz / kLowest_Hz, noise.uniform()),
               exemplar = std::exp(noise.normal(kExemplarSpread));
  // The level of a vibration above its threshold falls away from 250 Hz.
  const double felt_dB =
      kVibration_dB - (observer::vibration_threshold_dB(frequency_Hz) - observer::vibration_threshold_dB(250));
  const std::array senses{Ringing{cues == "vibration" ? 0 : kLoudness_dB, p.timing().sound_sd_s, kHeardDecayWeber},
                          Ringing{cues == "sound" ? 0 : felt_dB, p.timing().touch_sd_s, kHeardDecayWeber}};
  std::array<double, 3> evidence{};
  for (const Ringing& sense : senses) {
    const auto real =
        std::find_if(kMaterials.begin(), kMaterials.end(), [&](const Material& m) { return name == m.name; });
    const double duration_s =
        audible_s(time_constant_s(real->loss_factor * exemplar, frequency_Hz, support_s), sense.level_dB);
    const double perceived_s = duration_s + noise.normal(sense.sd_s(duration_s));
    if (sense.level_dB <= 0) continue;  // below the threshold of the sense
    for (std::size_t m = 0; m < kMaterials.size(); ++m)
      evidence[m] += log_likelihood(sense, perceived_s, kMaterials[m], frequency_Hz, support_s);
  }
  const auto best =
      static_cast<std::size_t>(std::max_element(evidence.begin(), evidence.end()) - evidence.begin());
  const bool felt = senses[0].level_dB > 0 || senses[1].level_dB > 0;
  return {{"right", kMaterials[attended && felt ? best : guess].name == name}};
}

}  // namespace tactus::experiments
