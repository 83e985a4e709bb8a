// The force of one impact over time. Pure.
#pragma once

#include <array>

namespace tactus::audio {

// A raised cosine of force: its share of the impulse, its start and its length.
struct Hump {
  int begin = 0;    // samples after the onset
  int samples = 0;  // 0: unused
  float share = 0;
};
// The blow, and up to four smaller ones that follow it when hard bodies meet.
using ForcePulse = std::array<Hump, 5>;
inline ForcePulse one_hump(int samples) { return {Hump{0, samples, 1}}; }

// Share of the impulse in that sample after the onset; 0 outside. The sum over all samples equals the sum of the
// shares.
float weight_at(const ForcePulse& pulse, int sample);
// Largest change of the weight from one sample to the next, from the sample before the onset to the one after the end. For a long
// hump of n samples it is 2 / n sin(pi / n); few samples miss the steepest places of the curve, and theirs is smaller.
float steepest(const ForcePulse& pulse);
// Samples from the onset to the end.
int length_of(const ForcePulse& pulse);

// True when another pulse can join: a hump is unused, or over before that sample after the onset.
bool has_room(const ForcePulse& pulse, int sample);
// Adds another pulse, scaled by `strength`, that begins `later` samples after the onset of this one and not before
// `sample`; both act in full. Humps of the other without a free place are added to its first one. Without any free
// place nothing happens.
void join(ForcePulse& pulse, int sample, const ForcePulse& other, int later, float strength);

}  // namespace tactus::audio
