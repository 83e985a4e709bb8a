// The direction-independent part of head-related responses: the resonance of the ear canal and the loudspeaker of
// the measurement. Pure.
#pragma once

#include <vector>

namespace tactus::audio {

// The minimum-phase filter that removes it, so that only differences between directions colour a sound
// (diffuse-field equalisation; Moeller, Applied Acoustics 36, 1992, section 5). responses: of one length. weights:
// of each, its part of the sphere (solid_angles() in hull.h), in any unit. Its resolution is that of a response of
// `taps` samples.
std::vector<float> diffuse_field_inverse(const std::vector<std::vector<float>>& responses,
                                         const std::vector<double>& weights, int taps);

}  // namespace tactus::audio
