// Fractional delay of a signal, by Lagrange's polynomial of fifth order through the six samples around (Laakso et
// al., "Splitting the unit delay", IEEE Signal Proc. Mag. 13, 1996, section on Lagrange interpolation). Pure.
#pragma once

#include <array>

namespace tactus::audio {

// Minimum delay, samples: half of the samples of the polynomial lie after its place.
inline constexpr int kMinDelay = 2;
// Number of samples read before the oldest whole sample of a delay.
inline constexpr int kDelayReach = 3;

// Weights of the samples at -2, -1, 0, 1, 2, 3 for the place x, 0 <= x <= 1.
std::array<float, 6> lagrange(float x);

// Adds to out[n] the value of `signal` at `delay` before sample n. The delay changes linearly from `from` to `to`,
// which it reaches at the last frame. `signal` has the past before it. Realtime-safe: yes.
void add_delayed(const float* signal, float from, float to, int frames, float* out);

}  // namespace tactus::audio
