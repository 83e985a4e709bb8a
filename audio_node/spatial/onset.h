// Onset of an impulse response, to a fraction of a sample, and its values between samples. Pure.
#pragma once

#include <cstddef>
#include <span>

namespace tactus::audio {

// Value at `t` samples after the first, of the signal below `cutoff` times half of the rate; 0 outside. A windowed
// sinc of kHalfWidth zeros to each side (Smith and Gossett, ICASSP 1984).
double value_at(std::span<const float> samples, double t, double cutoff = 1);

// Time at which it first reaches kOnset of its peak, samples; 0 without one. Used to align responses.
double onset(std::span<const float> samples);

// First sample that reaches kAudible of the peak; 0 without one. Used as the time of the sound.
std::size_t first_audible(std::span<const float> samples);

// A fifth of the peak, as in Algazi et al. ("The CIPIC HRTF database", WASPAA 2001, section 4).
inline constexpr double kOnset = 0.2;

// -34 dB: a sound weaker than this, less than a millisecond before the rest, is part of its beginning (design; as
// in tests/measure/measure_onsets).
inline constexpr double kAudible = 0.02;

}  // namespace tactus::audio
