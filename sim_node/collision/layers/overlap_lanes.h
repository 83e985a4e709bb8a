// Overlap test of one box against eight, for the instruction set that the including file is compiled for. Uses GCC's
// vector extensions. On machines with narrower vectors they are split, with bit-identical results, since no
// operations are fused.
#pragma once

#include "sim_node/collision/layers/lanes.h"

namespace tactus::sim {
namespace {

inline __attribute__((always_inline)) unsigned overlap_from(const WideNode& n, const BoxQuery& q, int first) {
  Floats d[3], t[3], c[3][3], ac[3][3], h[3], at, x;
  for (int k = 0; k < 3; ++k) {
    load(n.centre[k] + first, x);
    d[k] = q.centre[k] - x;
  }
  Ints apart{};
  for (int i = 0; i < 3; ++i) {
    Floats a0, a1, a2;
    load(n.axis[i][0] + first, a0);
    load(n.axis[i][1] + first, a1);
    load(n.axis[i][2] + first, a2);
    t[i] = a0 * d[0] + a1 * d[1] + a2 * d[2];
    for (int j = 0; j < 3; ++j) {
      c[i][j] = a0 * q.axis[j][0] + a1 * q.axis[j][1] + a2 * q.axis[j][2];
      magnitude(c[i][j], ac[i][j]);
    }
    load(n.half[i] + first, h[i]);
    h[i] += q.grow;
    magnitude(t[i], at);
    apart |= at > h[i] + q.half[0] * ac[i][0] + q.half[1] * ac[i][1] + q.half[2] * ac[i][2];
  }
  for (int j = 0; j < 3; ++j) {
    x = d[0] * q.axis[j][0] + d[1] * q.axis[j][1] + d[2] * q.axis[j][2];
    magnitude(x, at);
    apart |= at > q.half[j] + h[0] * ac[0][j] + h[1] * ac[1][j] + h[2] * ac[2][j];
  }
  const int count = n.count - first < kStep ? n.count - first : kStep;
  const unsigned used = (1u << count) - 1;
  if ((signs(apart) & used) == used) return 0;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      // These axes are shorter than one, so a bound in metres is also valid for them.
      x = t[i2] * c[i1][j] - t[i1] * c[i2][j];
      magnitude(x, at);
      apart |=
          at > h[i1] * ac[i2][j] + h[i2] * ac[i1][j] + q.half[j1] * ac[i][j2] + q.half[j2] * ac[i][j1] + q.slack;
    }
  }
  return ~signs(apart) & used;
}

inline __attribute__((always_inline)) unsigned overlap(const WideNode& n, const BoxQuery& q) {
  unsigned hit = overlap_from(n, q, 0);
  for (int first = kStep; first < n.count; first += kStep) hit |= overlap_from(n, q, first) << first;
  return hit;
}

}  // namespace
}  // namespace tactus::sim
