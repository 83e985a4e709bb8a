#include "audio_node/spatial/air.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {

double absorption_dB_m(double f, const Air& air) {
  constexpr double kReference_Pa = 101325, kReference_K = 293.15, kTriple_K = 273.16;
  const double kelvin = air.temperature_degC + 273.15, t = kelvin / kReference_K,
               p = air.pressure_Pa / kReference_Pa;
  const double saturation = std::pow(10, -6.8346 * std::pow(kTriple_K / kelvin, 1.261) + 4.6151);
  const double h = air.humidity_percent * saturation / p;  // molar concentration of vapour, percent
  const double oxygen_Hz = p * (24 + 4.04e4 * h * (0.02 + h) / (0.391 + h));
  const double nitrogen_Hz = p / std::sqrt(t) * (9 + 280 * h * std::exp(-4.170 * (std::pow(t, -1.0 / 3) - 1)));
  const double relaxation = 0.01275 * std::exp(-2239.1 / kelvin) / (oxygen_Hz + f * f / oxygen_Hz) +
                            0.1068 * std::exp(-3352.0 / kelvin) / (nitrogen_Hz + f * f / nitrogen_Hz);
  return 8.686 * f * f * (1.84e-11 / p * std::sqrt(t) + std::pow(t, -2.5) * relaxation);
}

float air_keep(double attenuation_dB, double rate_Hz) {
  if (!(attenuation_dB > 0)) return 0;
  const double w = 2 * std::numbers::pi * std::min(kAirFit_Hz, 0.4 * rate_Hz) / rate_Hz;
  // H|^2 = (1 - a)^2 / (1 + a^2 - 2 a cos w) = g, solved for a.
  const double g = std::pow(10, -attenuation_dB / 10), half = (1 - g * std::cos(w)) / (1 - g);
  return static_cast<float>(half - std::sqrt(half * half - 1));
}

}  // namespace tactus::audio
