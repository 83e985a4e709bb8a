// How the air between a source and the ear dulls its sound. Pure.
#pragma once

namespace tactus::audio {

struct Air {
  double temperature_degC = 20;
  double humidity_percent = 50;  // relative
  double pressure_Pa = 101325;
};

// Attenuation of a tone by a metre of air, dB (ISO 9613-1:1993, eqs. 3 to 5, and annex B for the vapour; Bass,
// Sutherland, Zuckerwar, Blackstock and Hester, J. Acoust. Soc. Am. 97, 1995).
double absorption_dB_m(double frequency_Hz, const Air& air = {});

// y <- (1 - keep) x + keep y: the one-pole low-pass that takes as much as the air off a tone of kAirFit_Hz. Up to
// there both fall with the square of the frequency.
float air_keep(double attenuation_dB, double rate_Hz);
inline constexpr double kAirFit_Hz = 8000;  // design: the highest octave in which rooms are measured

}  // namespace tactus::audio
