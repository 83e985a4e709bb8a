// Where an impulse response begins, to a fraction of a sample, and what it is between its samples. Pure.
#pragma once

#include <cstddef>
#include <span>

namespace tactus::audio {

// Value at `t` samples after the first, of what the samples stand for below `cutoff` times half of their rate;
// outside of them it is 0. A windowed sinc of kHalfWidth zeros to each side (Smith and Gossett, ICASSP 1984).
double value_at(std::span<const float> samples, double t, double cutoff = 1);

// When it first reaches kOnset of its largest sample; 0 where there is none. It aligns responses with one another.
double onset(std::span<const float> samples);

// First sample that reaches kHeard of the largest; 0 where there is none. It says when something sounds.
std::size_t first_heard(std::span<const float> samples);

// A fifth of the peak, as Algazi et al. take it ("The CIPIC HRTF database", WASPAA 2001, section 4).
inline constexpr double kOnset = 0.2;

// -34 dB: what comes so much weaker, less than a millisecond before the rest, is part of its beginning (design; as
// tests/measure/measure_onsets reads a recording).
inline constexpr double kHeard = 0.02;

}  // namespace tactus::audio
