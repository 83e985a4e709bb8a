// Which of two materials cools the finger more: Ho and Jones 2006, Bergmann Tiest and Kappers 2009. Finger and
// material are semi-infinite bodies with a contact resistance; the participant compares the heat that leaves the
// finger.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "scripts/experiments/paradigms.h"
#include "scripts/simulated_player/observer/noise_stream.h"
#include "scripts/simulated_player/observer/touch.h"

namespace tactus::experiments {
namespace {

// Effusivity of skin, W s^0.5/(m^2 K): conductivity 0.37, density 1000 and heat capacity 3770 (SI units,
// unverified).
constexpr double kSkinEffusivity = 1181;
constexpr double kFelt_s = 1;  // design: the heat of the first second decides

// exp(x^2) erfc(x), x at least 0.
double scaled_erfc(double x) {
  if (x < 5) return std::exp(x * x) * std::erfc(x);
  const double y = 1 / (2 * x * x);  // asymptotic series, relative error below 1e-5 here
  return (1 - y * (1 - 3 * y * (1 - 5 * y))) / (x * std::sqrt(std::numbers::pi));
}

struct Contact {
  double effusivity, conductivity_W_mK, difference_K;

  // Fall of the temperature of the skin after this time, K (Carslaw and Jaeger, with the contact resistance
  // (0.37 + k)/(1870 k) of Ho and Jones 2008, IEEE Transactions on Haptics 1:53; unverified).
  double fall_K(double time_s) const {
    const double conductance = 1870 * conductivity_W_mK / (0.37 + conductivity_W_mK),
                 rate = conductance * (1 / kSkinEffusivity + 1 / effusivity);
    return difference_K * effusivity / (kSkinEffusivity + effusivity) *
           (1 - scaled_erfc(rate * std::sqrt(time_s)));
  }
};

Contact contact(const TrialSettings& s, const std::string& which, double difference_K) {
  return {s.number(which + "_effusivity", 1, 1e6), s.number(which + "_conductivity", 1e-3, 1e4), difference_K};
}

}  // namespace

// Settings: for first and second _effusivity in W s^0.5/(m^2 K) and _conductivity in W/(m K); skin_degC,
// object_degC; flow_percent: instead of the second material, a heat flow larger than that of the first by this.
// Answers `right`: the cooler one was named; fall_K: fall of the skin on the first after after_s.
Outcome contact_cooling(Participant& p, const TrialSettings& s, std::uint64_t number) {
  const double difference_K = s.number_or("skin_degC", 33, 0, 50) - s.number_or("object_degC", 23, 0, 60);
  const Contact one = contact(s, "first", difference_K);
  const double after_s = s.number_or("after_s", 10, 0.01, 100), first = one.fall_K(kFelt_s);
  const double percent = s.number_or("flow_percent", -1000, -100, 1000);
  const double second =
      percent > -1000 ? first * (1 + percent / 100) : contact(s, "second", difference_K).fall_K(kFelt_s);
  observer::NoiseStream noise(p.trial_seed("contact_cooling", number), 1);
  const bool attended = noise.uniform() >= p.player().lapse, guess = noise.uniform() < 0.5;
  const double felt_first = observer::felt_heat_flow(p.player(), first, noise),
               felt_second = observer::felt_heat_flow(p.player(), second, noise);
  const bool named_second = felt_second > felt_first, cooler_is_second = second > first;
  const bool decided = attended && felt_first != felt_second && first != second;
  return {{"right", decided ? named_second == cooler_is_second : guess}, {"fall_K", one.fall_K(after_s)}};
}

}  // namespace tactus::experiments
