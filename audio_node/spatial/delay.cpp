#include "audio_node/spatial/delay.h"

#include <algorithm>
#include <cmath>

namespace tactus::audio {

std::array<float, 6> lagrange(float x) {
  // Each is the product of (x - j) / (i - j) over the other five samples j.
  const float a = x + 2, b = x + 1, c = x, d = x - 1, e = x - 2, f = x - 3;
  const float ab = a * b, cd = c * d, ef = e * f;
  return {b * cd * ef / -120, a * cd * ef / 24,  ab * d * ef / -12,
          ab * c * ef / 12,   ab * cd * f / -24, ab * cd * e / 120};
}

void add_delayed(const float* signal, float from, float to, int frames, float* out) {
  if (from == to) {
    const float whole = std::floor(to) + 1;
    const std::array<float, 6> w = lagrange(whole - to);
    const float* const s = signal - static_cast<int>(whole) - 2;
    for (int n = 0; n < frames; ++n)
      out[n] +=
          w[0] * s[n] + w[1] * s[n + 1] + w[2] * s[n + 2] + w[3] * s[n + 3] + w[4] * s[n + 4] + w[5] * s[n + 5];
    return;
  }
  // In runs over the same six samples and their neighbours, which are computed in vectors. A place that rounding
  // moves slightly out of 0 .. 1 does no harm: the polynomial continues.
  const float step = (to - from) / static_cast<float>(frames);
  for (int n = 0; n < frames;) {
    const float first = from + step * static_cast<float>(n + 1), whole = std::ceil(first);
    const float left = step > 0 ? whole - first : first - whole + 1;
    const float run = std::min(std::floor(left / std::abs(step)) + 1, static_cast<float>(frames - n));
    const int end = n + std::max(1, static_cast<int>(run));
    const float* const s = signal - static_cast<int>(whole) - 2;
    for (; n < end; ++n) {
      const std::array<float, 6> w = lagrange(whole - (from + step * static_cast<float>(n + 1)));
      out[n] +=
          w[0] * s[n] + w[1] * s[n + 1] + w[2] * s[n + 2] + w[3] * s[n + 3] + w[4] * s[n + 4] + w[5] * s[n + 5];
    }
  }
}

}  // namespace tactus::audio
