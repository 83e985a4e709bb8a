// How steady a force is that should be: what flickers of it, in which bands, and how often it is gone.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace tactus::bench {

inline constexpr int kBands = 9;  // octaves from 1 Hz: 1-2, 2-4, ..., 256-500 Hz

struct Steadiness {
  int windows = 0;                     // of half a second, in which there was contact
  double jitter = 0;                   // rms of what is faster than 20 Hz, by the mean; median over the windows
  double gone = 0;                     // share of the steps without force
  std::array<double, kBands> bands{};  // rms in each octave, by the mean; root of the mean square over the windows
};

// Each series: the force of one contact, N, sampled at rate_Hz. Windows with less than nine tenths of contact are
// left out, but for `all`: then those without any.
Steadiness steadiness(std::span<const std::vector<double>> series, double rate_Hz, bool all = false);

}  // namespace tactus::bench
