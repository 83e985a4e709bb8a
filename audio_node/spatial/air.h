// Air absorption between a source and the ear. Pure.
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

// y <- (1 - keep) x + keep y: coefficient of the one-pole low-pass that attenuates a tone of kAirFit_Hz as the air
// does. Below it both attenuations fall with the square of the frequency.
float air_keep(double attenuation_dB, double rate_Hz);
inline constexpr double kAirFit_Hz = 8000;  // design: the highest octave in which rooms are measured

}  // namespace tactus::audio
