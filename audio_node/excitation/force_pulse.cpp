#include "audio_node/excitation/force_pulse.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {
namespace {

// Sample i of a raised cosine of n samples with sum 1.
float raised_cosine(int i, int n) {
  if (i < 0 || i >= n) return 0;
  if (n == 1) return 1;
  return (1 - std::cos(2 * std::numbers::pi_v<float> * (static_cast<float>(i) + 0.5f) / static_cast<float>(n))) /
         static_cast<float>(n);
}

bool is_free(const Hump& h, int sample) { return h.samples <= 0 || h.begin + h.samples <= sample; }

}  // namespace

float weight_at(const ForcePulse& pulse, int sample) {
  float sum = 0;
  for (const Hump& h : pulse)
    if (h.samples > 0) sum += h.share * raised_cosine(sample - h.begin, h.samples);
  return sum;
}

bool has_room(const ForcePulse& pulse, int sample) {
  return std::any_of(pulse.begin(), pulse.end(), [&](const Hump& h) { return is_free(h, sample); });
}

void join(ForcePulse& pulse, int sample, const ForcePulse& other, int later, float strength) {
  Hump* first = nullptr;
  for (const Hump& h : other) {
    if (h.samples <= 0) continue;
    const auto free =
        std::find_if(pulse.begin(), pulse.end(), [&](const Hump& of) { return is_free(of, sample); });
    if (free != pulse.end()) {
      *free = {h.begin + later, h.samples, strength * h.share};
      if (!first) first = &*free;
    } else if (first) {
      first->share += strength * h.share;
    }
  }
}

float steepest(const ForcePulse& pulse) {
  float most = 0, before = 0;
  for (int i = 0; i <= length_of(pulse); ++i) {
    const float weight = weight_at(pulse, i);
    most = std::max(most, std::abs(weight - before));
    before = weight;
  }
  return most;
}

int length_of(const ForcePulse& pulse) {
  int end = 0;
  for (const Hump& h : pulse) end = std::max(end, h.begin + h.samples);
  return end;
}

}  // namespace tactus::audio
