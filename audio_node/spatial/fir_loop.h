// The loop of fir.h in vectors of kWidth numbers. One file per instruction set includes it, as with
// bank/ring_loop.h.
#pragma once

#include "audio_node/spatial/fir.h"

namespace tactus::audio::TACTUS_FIR {
namespace {

constexpr int kWidth = TACTUS_FIR_WIDTH;
// Number of sums that fit into the registers together with their operands: filters share each load of the input.
constexpr int kSums = kWidth == 16 ? 16 : 8;
typedef float Lanes __attribute__((vector_size(4 * TACTUS_FIR_WIDTH)));
typedef float UnalignedLanes __attribute__((vector_size(4 * TACTUS_FIR_WIDTH), aligned(4)));

inline Lanes broadcast(float x) { return x - Lanes{}; }
inline Lanes load(const float* from) { return *reinterpret_cast<const UnalignedLanes*>(from); }
inline void store(float* to, Lanes x) { *reinterpret_cast<UnalignedLanes*>(to) = x; }

template <int kFilters>
void filter_block(const float* input, const float* const* filters, int taps, float* const* out) {
  constexpr int kVectorsPerBlock = kMaxBlock / kWidth, kMaxVectors = kSums / kFilters,
                kVectorsAtOnce = kMaxVectors < kVectorsPerBlock ? kMaxVectors : kVectorsPerBlock;
  static_assert(kMaxBlock % (kVectorsAtOnce * kWidth) == 0);
  for (int n = 0; n < kMaxBlock; n += kVectorsAtOnce * kWidth) {
    Lanes sum[kFilters][kVectorsAtOnce] = {};
    for (int k = 0; k < taps; ++k) {
      Lanes x[kVectorsAtOnce];
      for (int j = 0; j < kVectorsAtOnce; ++j) x[j] = load(input + n + j * kWidth - k);
      for (int i = 0; i < kFilters; ++i) {
        const Lanes h = broadcast(filters[i][k]);
        for (int j = 0; j < kVectorsAtOnce; ++j) sum[i][j] += h * x[j];
      }
    }
    for (int i = 0; i < kFilters; ++i)
      for (int j = 0; j < kVectorsAtOnce; ++j) store(out[i] + n + j * kWidth, sum[i][j]);
  }
}

}  // namespace

void fir(const float* input, const float* const* filters, int count, int taps, float* const* out) {
  if (count == 2)
    filter_block<2>(input, filters, taps, out);
  else
    filter_block<4>(input, filters, taps, out);
}

}  // namespace tactus::audio::TACTUS_FIR
