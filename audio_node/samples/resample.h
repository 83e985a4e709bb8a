// A recording at another rate. Pure.
#pragma once

#include <vector>

namespace tactus::audio {

// By a windowed sinc of 32 zero crossings, with all that the slower of the two rates cannot hold taken out.
// Allocates, and takes about 30 ms for a second at 48 kHz: not for a loop.
std::vector<float> resample(const std::vector<float>& in, double from_Hz, double to_Hz);

}  // namespace tactus::audio
