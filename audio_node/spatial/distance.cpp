#include "audio_node/spatial/distance.h"

#include <algorithm>

#include "audio_node/spatial/air.h"

namespace tactus::audio {

Distance::Distance(double rate_Hz) : rate_Hz_(rate_Hz), air_dB_m_(absorption_dB_m(kAirFit_Hz)) {}

void Distance::apply(const float* in, float distance_m, int frames, float* out) {
  float gain = gain_, keep = keep_;
  if (fresh_ || distance_m != distance_m_) {
    distance_m_ = distance_m;
    gain_ = 1 / distance_m;
    keep_ = air_keep(air_dB_m_ * static_cast<double>(std::max(0.f, distance_m - 1)), rate_Hz_);
  }
  if (fresh_) gain = gain_, keep = keep_, low_ = 0, fresh_ = false;
  const float gain_step = (gain_ - gain) / static_cast<float>(frames);
  const float keep_step = (keep_ - keep) / static_cast<float>(frames);
  for (int n = 0; n < frames; ++n) {
    gain += gain_step, keep += keep_step;
    low_ = keep * low_ + (1 - keep) * in[n];
    out[n] = gain * low_;
  }
}

}  // namespace tactus::audio
