#include "audio_node/force_pulse.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {
namespace {

// Sample i of a raised cosine of n samples whose sum is 1.
float raised_cosine(int i, int n) {
  if (i < 0 || i >= n) return 0;
  if (n == 1) return 1;
  return (1 - std::cos(2 * std::numbers::pi_v<float> * (static_cast<float>(i) + 0.5f) / static_cast<float>(n))) /
         static_cast<float>(n);
}

}  // namespace

float weight_at(const ForcePulse& pulse, int sample) {
  float sum = 0;
  for (const Hump& h : pulse)
    if (h.samples > 0) sum += h.share * raised_cosine(sample - h.begin, h.samples);
  return sum;
}

int length_of(const ForcePulse& pulse) {
  int end = 0;
  for (const Hump& h : pulse) end = std::max(end, h.begin + h.samples);
  return end;
}

}  // namespace tactus::audio
