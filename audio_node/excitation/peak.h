// Peak pressure of a strike before scaling. Pure.
#pragma once

#include "audio_node/excitation/strike.h"

namespace tactus::audio {

// Largest pressure at 1 m, Pa, of both bodies together from rest, from the first sample to 10 ms after the blow,
// by simulation of the modes. Impulses in N s, clicks in Pa. Uses the same instructions on every machine, so that
// all scale alike.
double peak_Pa(const Strike& strike, double rate_Hz);

}  // namespace tactus::audio
