// Sample-rate conversion of a recording. Pure.
#pragma once

#include <vector>

namespace tactus::audio {

// Uses a windowed sinc of 32 zero crossings. Removes all frequencies above the bandwidth of the lower rate.
// Allocates, and takes about 30 ms per second at 48 kHz: do not call it in a loop.
std::vector<float> resample(const std::vector<float>& in, double from_Hz, double to_Hz);

}  // namespace tactus::audio
