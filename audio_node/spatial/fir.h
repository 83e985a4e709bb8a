// Two filters on one input, in vectors of the instructions that the processor has (bank/ring.h). Pure.
#pragma once

#include "audio_node/bank/ring.h"

namespace tactus::audio {

// out[n] = sum over k < taps of filter[k] input[n - k], for n < kMaxBlock; `input` has taps samples of the past
// before it. taps: a multiple of 4. Realtime-safe: yes.
using FirPair = void (*)(const float* input, const float* left, const float* right, int taps, float* out_left,
                         float* out_right);

FirPair fir_pair(Instructions instructions);

}  // namespace tactus::audio
