// The loop of ring.h in vectors of kWidth numbers. One file per instruction set includes it and names the
// namespace, so that the linker never merges their code; for the same reason it uses nothing of the standard
// library.
#pragma once

#include "audio_node/modal/bank/ring.h"

namespace tactus::audio::TACTUS_RING {
namespace {

typedef float Lanes __attribute__((vector_size(4 * TACTUS_RING_WIDTH)));
constexpr int kWidth = TACTUS_RING_WIDTH;
// Vectors processed together, so that none waits for its own last result.
constexpr int kVectorsAtOnce = 4;

inline Lanes broadcast(float x) { return x - Lanes{}; }
inline Lanes load(const float* from) { return *reinterpret_cast<const Lanes*>(from); }
inline void store(float* to, Lanes x) { *reinterpret_cast<Lanes*>(to) = x; }

// kVectors * kWidth modes from `at` on, under `count` pushes; kPushes: their number if known, otherwise -1.
template <int kVectors, int kPushes>
void add_modes(const Ringing& m, int at, const Push* pushes, int count, int frames, Lanes* sum) {
  Lanes c[kVectors], k[kVectors], v[kVectors], u[kVectors], g[kVectors];
  for (int j = 0; j < kVectors; ++j) {
    const int i = at + j * kWidth;
    c[j] = load(m.damping + i), k[j] = load(m.stiffness + i);
    v[j] = load(m.velocity + i), u[j] = load(m.displacement + i);
    if (kPushes == 1) g[j] = load(pushes[0].gains + i);
  }
  for (int n = 0; n < frames; ++n) {
    Lanes force;
    if (kPushes == 1) force = broadcast(pushes[0].force[n]);
    for (int j = 0; j < kVectors; ++j) {
      v[j] = c[j] * v[j] - k[j] * u[j];
      if (kPushes == 1) v[j] += g[j] * force;
      if (kPushes < 0)
        for (int p = 0; p < count; ++p) v[j] += load(pushes[p].gains + at + j * kWidth) * broadcast(pushes[p].force[n]);
      u[j] += v[j];
    }
    Lanes total = v[0];
    for (int j = 1; j < kVectors; ++j) total += v[j];
    sum[n] += total;
  }
  for (int j = 0; j < kVectors; ++j) {
    const int i = at + j * kWidth;
    store(m.velocity + i, v[j]), store(m.displacement + i, u[j]);
  }
}

template <int kPushes>
void add_groups(const Ringing& m, const Push* pushes, int count, int frames, Lanes* sum) {
  int at = 0;
  for (; at + kVectorsAtOnce * kWidth <= m.modes; at += kVectorsAtOnce * kWidth)
    add_modes<kVectorsAtOnce, kPushes>(m, at, pushes, count, frames, sum);
  // A group is one vector of 16, two of 8 or four of 4.
  constexpr int kVectorsPerGroup = kModeGroup / kWidth;
  for (; at < m.modes; at += kModeGroup) add_modes<kVectorsPerGroup, kPushes>(m, at, pushes, count, frames, sum);
}

}  // namespace

void ring(const Ringing& m, const Push* pushes, int count, int frames, float* out) {
  Lanes sum[kMaxBlock];
  for (int n = 0; n < frames; ++n) sum[n] = Lanes{};
  if (count == 0)
    add_groups<0>(m, pushes, count, frames, sum);
  else if (count == 1)
    add_groups<1>(m, pushes, count, frames, sum);
  else
    add_groups<-1>(m, pushes, count, frames, sum);
  for (int n = 0; n < frames; ++n) {
    float total = 0;
    for (int i = 0; i < kWidth; ++i) total += sum[n][i];
    out[n] += total;
  }
}

}  // namespace tactus::audio::TACTUS_RING
