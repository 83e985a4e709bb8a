// Law from computed pressure to played level, for impacts, scrapes and rolls (excitation/impact.cpp and sliding.cpp). Recorded
// impacts follow their impulse instead (recorded_blow_level() in excitation/sampler.h). Pure.
#pragma once

#include <algorithm>
#include <cmath>

#include "audio_node/settings.gen.h"

namespace tactus::audio {

// Level at 1 m, full scale, of a peak pressure: the reference pressure gives the reference level, others follow in proportion, or
// compressed by a loudness_exponent below 1. At most 12 dB above the reference, so that the limiter acts only in exceptional
// cases (design).
inline double played_level(double pressure_Pa, const Settings& settings) {
  return settings.reference_level *
         std::min(4.0, std::pow(pressure_Pa / settings.reference_pressure_Pa, settings.loudness_exponent));
}

}  // namespace tactus::audio
