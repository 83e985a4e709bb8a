// Vectors of lanes for the instruction set that the including file is compiled for. Uses GCC's vector extensions. On
// machines with narrower vectors they are split, with bit-identical results, since no operations are fused.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#else
#include <cmath>
#endif

#include "sim_node/collision/layers/wide_node.h"

namespace tactus::sim {
namespace {

// Number of lanes that a register holds.
#if defined(__AVX__)
constexpr int kStep = 8;
#else
constexpr int kStep = 4;
#endif
static_assert(kLanes % kStep == 0);

typedef float Floats __attribute__((vector_size(4 * kStep), may_alias));
typedef int Ints __attribute__((vector_size(4 * kStep), may_alias));

inline __attribute__((always_inline)) void load(const float* from, Floats& to) {
  to = *reinterpret_cast<const Floats*>(from);
}

inline __attribute__((always_inline)) void magnitude(const Floats& x, Floats& out) {
  out = reinterpret_cast<const Floats&>(static_cast<const Ints&>(reinterpret_cast<const Ints&>(x) & 0x7fffffff));
}

inline __attribute__((always_inline)) unsigned signs(const Ints& m) {
#if defined(__AVX__)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<const __m256&>(m)));
#elif defined(__SSE2__)
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<const __m128&>(m)));
#else
  unsigned bits = 0;
  for (int i = 0; i < kStep; ++i) bits |= (m[i] < 0 ? 1u : 0u) << i;
  return bits;
#endif
}

inline __attribute__((always_inline)) void root(const Floats& x, Floats& out) {
#if defined(__AVX__)
  reinterpret_cast<__m256&>(out) = _mm256_sqrt_ps(reinterpret_cast<const __m256&>(x));
#elif defined(__SSE2__)
  reinterpret_cast<__m128&>(out) = _mm_sqrt_ps(reinterpret_cast<const __m128&>(x));
#else
  for (int i = 0; i < kStep; ++i) out[i] = std::sqrt(x[i]);
#endif
}

}  // namespace
}  // namespace tactus::sim
