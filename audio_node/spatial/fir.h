// Two or four FIR filters on one input, with the vector instructions of the processor (bank/ring.h). Pure.
#pragma once

#include "audio_node/modal/bank/ring.h"

namespace tactus::audio {

// out[i][n] = sum over k < taps of filters[i][k] input[n - k], for n < kMaxBlock and i < count, which is 2 or 4;
// `input` has taps samples of the past before it. Realtime-safe: yes.
using Fir = void (*)(const float* input, const float* const* filters, int count, int taps, float* const* out);

Fir fir(Instructions instructions);

}  // namespace tactus::audio
