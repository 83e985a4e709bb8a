// A recording between its samples. Pure.
#pragma once

namespace tactus::audio {

// Between b and c, `part` of the way (Catmull and Rom 1974): through the samples, with a steady slope.
// Realtime-safe: yes.
inline float between(float a, float b, float c, float d, float part) {
  const float slope_b = 0.5f * (c - a), slope_c = 0.5f * (d - b), rise = c - b;
  return b + part * (slope_b + part * (3 * rise - 2 * slope_b - slope_c + part * (slope_b + slope_c - 2 * rise)));
}

}  // namespace tactus::audio
