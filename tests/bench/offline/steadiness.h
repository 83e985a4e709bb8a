// Steadiness of a force that should be constant: its fluctuation by bands, and the share of missing force.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace tactus::bench {

inline constexpr int kBands = 9;  // octaves from 1 Hz: 1-2, 2-4, ..., 256-500 Hz

struct Steadiness {
  int windows = 0;                     // windows of half a second with contact
  double jitter = 0;                   // rms above 20 Hz, relative to the mean; median over the windows
  double gone = 0;                     // share of the steps without force
  std::array<double, kBands> bands{};  // rms in each octave, relative to the mean; root of the mean square over the windows
};

// Each series: the force of one contact, N, sampled at rate_Hz. Windows with less than nine tenths of contact are left out; with `all`,
// only those without any contact.
Steadiness steadiness(std::span<const std::vector<double>> series, double rate_Hz, bool all = false);

}  // namespace tactus::bench
