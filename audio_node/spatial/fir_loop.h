// The loop of fir.h in vectors of kWidth numbers. One file per instruction set includes it, as with
// bank/ring_loop.h.
#pragma once

#include "audio_node/spatial/fir.h"

namespace tactus::audio::TACTUS_FIR {
namespace {

constexpr int kWidth = TACTUS_FIR_WIDTH;
// Number of sums that fit into the registers beside their operands: filters share each load of the input.
constexpr int kSums = kWidth == 16 ? 16 : 8;
typedef float Lanes __attribute__((vector_size(4 * TACTUS_FIR_WIDTH)));
typedef float Anywhere __attribute__((vector_size(4 * TACTUS_FIR_WIDTH), aligned(4)));

inline Lanes all(float x) { return x - Lanes{}; }
inline Lanes load(const float* from) { return *reinterpret_cast<const Anywhere*>(from); }
inline void store(float* to, Lanes x) { *reinterpret_cast<Anywhere*>(to) = x; }

template <int kFilters>
void some(const float* input, const float* const* filters, int taps, float* const* out) {
  constexpr int kMax = kMaxBlock / kWidth, kFit = kSums / kFilters, kAtOnce = kFit < kMax ? kFit : kMax;
  static_assert(kMaxBlock % (kAtOnce * kWidth) == 0);
  for (int n = 0; n < kMaxBlock; n += kAtOnce * kWidth) {
    Lanes sum[kFilters][kAtOnce] = {};
    for (int k = 0; k < taps; ++k) {
      Lanes x[kAtOnce];
      for (int j = 0; j < kAtOnce; ++j) x[j] = load(input + n + j * kWidth - k);
      for (int i = 0; i < kFilters; ++i) {
        const Lanes h = all(filters[i][k]);
        for (int j = 0; j < kAtOnce; ++j) sum[i][j] += h * x[j];
      }
    }
    for (int i = 0; i < kFilters; ++i)
      for (int j = 0; j < kAtOnce; ++j) store(out[i] + n + j * kWidth, sum[i][j]);
  }
}

}  // namespace

void fir(const float* input, const float* const* filters, int count, int taps, float* const* out) {
  if (count == 2)
    some<2>(input, filters, taps, out);
  else
    some<4>(input, filters, taps, out);
}

}  // namespace tactus::audio::TACTUS_FIR
