// What the ears hear from every direction alike: the resonance of the ear's canal and the loudspeaker that
// measured it. Pure.
#pragma once

#include <vector>

namespace tactus::audio {

// The filter of least phase that undoes it, so that only differences between directions colour a sound
// (diffuse-field equalisation; Moeller, Applied Acoustics 36, 1992, section 5). responses: of one length.
// weights: of each, the part of the sphere that it stands for (solid_angles() in hull.h), in any unit. No finer
// than a response of `taps` samples can be.
std::vector<float> diffuse_field_inverse(const std::vector<std::vector<float>>& responses,
                                         const std::vector<double>& weights, int taps);

}  // namespace tactus::audio
