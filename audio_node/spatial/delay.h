// Reads a signal a fraction of a sample late, by Lagrange's polynomial of fifth order through the six samples
// around (Laakso et al., "Splitting the unit delay", IEEE Signal Proc. Mag. 13, 1996, section on Lagrange
// interpolation). Pure.
#pragma once

#include <array>

namespace tactus::audio {

// No delay can be shorter: half of the polynomial's samples lie after its place. Samples.
inline constexpr int kLeastDelay = 2;
// So many samples before the oldest whole one that a delay reaches are read too.
inline constexpr int kDelayReach = 3;

// Weights of the samples at -2, -1, 0, 1, 2, 3 for the place x, 0 <= x <= 1.
std::array<float, 6> lagrange(float x);

// Adds to out[n] what `signal` was `delay` before its sample n, where the delay goes from one value straight to
// the other: at the last of the frames it is `to`. `signal` has the past before it. Realtime-safe: yes.
void add_delayed(const float* signal, float from, float to, int frames, float* out);

}  // namespace tactus::audio
