// The force of one impact over time. Pure.
#pragma once

#include <array>

namespace tactus::audio {

// A raised cosine of force: the share of the impulse that it carries, from when, how long.
struct Hump {
  int begin = 0;    // samples after the onset
  int samples = 0;  // 0: none
  float share = 0;
};
// The blow, and up to four smaller ones that follow it when hard bodies meet.
using ForcePulse = std::array<Hump, 5>;
inline ForcePulse one_hump(int samples) { return {Hump{0, samples, 1}}; }

// Its share of the impulse in that sample after the onset; 0 outside. The sum over all samples is that of the
// shares.
float weight_at(const ForcePulse& pulse, int sample);
// Samples from the onset until it is over.
int length_of(const ForcePulse& pulse);

// Whether one more can join it: some hump is none, or over before that sample after the onset.
bool has_room(const ForcePulse& pulse, int sample);
// Another one, `strength` as strong, that begins `later` samples after the onset of this one and not before
// `sample`: both are felt in full. Of the other's humps what finds no room comes with its first one. Nothing
// happens without room for any.
void join(ForcePulse& pulse, int sample, const ForcePulse& other, int later, float strength);

}  // namespace tactus::audio
