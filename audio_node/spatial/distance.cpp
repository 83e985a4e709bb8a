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
  if (gain == gain_ && keep == keep_) return hold(in, frames, out);
  const float gain_step = (gain_ - gain) / static_cast<float>(frames);
  const float keep_step = (keep_ - keep) / static_cast<float>(frames);
  for (int n = 0; n < frames; ++n) {
    gain += gain_step, keep += keep_step;
    low_ = keep * low_ + (1 - keep) * in[n];
    out[n] = gain * low_;
  }
}

// Four samples at a time, to shorten the dependency chain.
void Distance::hold(const float* in, int frames, float* out) {
  const float k = keep_, k2 = k * k, k3 = k2 * k, k4 = k2 * k2, b = 1 - k;
  int n = 0;
  for (; n + 4 <= frames; n += 4) {
    const float p0 = b * in[n], p1 = k * p0 + b * in[n + 1], p2 = k * p1 + b * in[n + 2],
                p3 = k * p2 + b * in[n + 3];
    out[n] = gain_ * (p0 + k * low_), out[n + 1] = gain_ * (p1 + k2 * low_);
    out[n + 2] = gain_ * (p2 + k3 * low_), out[n + 3] = gain_ * (p3 + k4 * low_);
    low_ = p3 + k4 * low_;
  }
  for (; n < frames; ++n) {
    low_ = k * low_ + b * in[n];
    out[n] = gain_ * low_;
  }
}

}  // namespace tactus::audio
