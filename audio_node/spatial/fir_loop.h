// The loop of fir.h in vectors of kWidth numbers. Included by one file per set of instructions, as
// bank/ring_loop.h is.
#pragma once

#include "audio_node/spatial/fir.h"

namespace tactus::audio::TACTUS_FIR {
namespace {

constexpr int kWidth = TACTUS_FIR_WIDTH;
// Of outputs at once, for each ear: they share the input, and none waits for its own last sum.
constexpr int kAtOnce = 4;
typedef float Lanes __attribute__((vector_size(4 * TACTUS_FIR_WIDTH)));
typedef float Anywhere __attribute__((vector_size(4 * TACTUS_FIR_WIDTH), aligned(4)));

inline Lanes all(float x) { return x - Lanes{}; }
inline Lanes load(const float* from) { return *reinterpret_cast<const Anywhere*>(from); }
inline void store(float* to, Lanes x) { *reinterpret_cast<Anywhere*>(to) = x; }

}  // namespace

void fir_pair(const float* input, const float* left, const float* right, int taps, float* out_left,
              float* out_right) {
  static_assert(kMaxBlock % (kAtOnce * kWidth) == 0);
  for (int n = 0; n < kMaxBlock; n += kAtOnce * kWidth) {
    Lanes l[kAtOnce] = {}, r[kAtOnce] = {};
    for (int k = 0; k < taps; ++k) {
      const Lanes a = all(left[k]), b = all(right[k]);
      for (int j = 0; j < kAtOnce; ++j) {
        const Lanes x = load(input + n + j * kWidth - k);
        l[j] += a * x, r[j] += b * x;
      }
    }
    for (int j = 0; j < kAtOnce; ++j)
      store(out_left + n + j * kWidth, l[j]), store(out_right + n + j * kWidth, r[j]);
  }
}

}  // namespace tactus::audio::TACTUS_FIR
