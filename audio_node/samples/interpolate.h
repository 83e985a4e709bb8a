// Interpolation between the samples of a recording. Pure.
#pragma once

#include <array>
#include <cstddef>

namespace tactus::audio {

// Between b and c at the fraction `part` (Catmull and Rom 1974): through the samples, with continuous slope.
// Realtime-safe: yes.
inline float between(float a, float b, float c, float d, float part) {
  const float slope_b = 0.5f * (c - a), slope_c = 0.5f * (d - b), rise = c - b;
  return b + part * (slope_b + part * (3 * rise - 2 * slope_b - slope_c + part * (slope_b + slope_c - 2 * rise)));
}

// Reads a part of a recording: out[k] = x(at + k step), as far as all four samples are inside, at most max_count.
// Returns the count. `at` lies within the recording. Realtime-safe: yes.
inline int stretch(const float* x, std::size_t size, double at, double step, float* out, int max_count) {
  if (at < 1 || size < 4) return 0;
  const double room = (static_cast<double>(size) - 3 - at) / step;  // the last one is at size - 3 and a fraction
  if (room < 0) return 0;
  const int count = room < max_count ? static_cast<int>(room) : max_count;
  const float* from = x + static_cast<std::size_t>(at);
  const double begin = at - static_cast<double>(static_cast<std::size_t>(at));
  // At its own pitch it is only copied.
  if (step == 1 && begin == 0) {
    for (int k = 0; k < count; ++k) out[k] = from[k];
    return count;
  }
  // In stages, so that all but the loads are vectorised.
  constexpr int kStage = 64;
  std::array<int, kStage> whole;
  std::array<float, kStage> part, a, b, c, d;
  for (int done = 0; done < count; done += kStage) {
    const int now = count - done < kStage ? count - done : kStage;
    for (std::size_t k = 0; k < kStage; ++k) {
      const double here = begin + (done + static_cast<int>(k)) * step;
      whole[k] = static_cast<int>(here);
      part[k] = static_cast<float>(here - whole[k]);
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(now); ++k) {
      const float* p = from + whole[k];
      a[k] = p[-1], b[k] = p[0], c[k] = p[1], d[k] = p[2];
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(now); ++k)
      out[done + static_cast<int>(k)] = between(a[k], b[k], c[k], d[k], part[k]);
  }
  return count;
}

}  // namespace tactus::audio
