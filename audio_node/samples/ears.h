// Puts the mono sound of a recording where it is heard from. Pure.
#pragma once

#include "audio_node/pan.h"

namespace tactus::audio {

// Of one sound. A place that moves is followed within a block.
struct Ears {
  float left = -1, right = -1;  // negative: it has not been heard yet

  // Adds `frames` frames, left and right interleaved. Realtime-safe: yes.
  void add(const Place& place, const float* mono, float* mix, int frames) {
    const auto [to_left, to_right] = pan(place);
    if (left < 0) left = to_left, right = to_right;
    const float step_left = (to_left - left) / static_cast<float>(frames);
    const float step_right = (to_right - right) / static_cast<float>(frames);
    for (int n = 0; n < frames; ++n) {
      left += step_left, right += step_right;
      mix[2 * n] += left * mono[n];
      mix[2 * n + 1] += right * mono[n];
    }
    left = to_left, right = to_right;
  }
};

}  // namespace tactus::audio
