// Tests of one query against eight features, for the instruction set that the including file is compiled for.
#pragma once

#include "sim_node/collision/features/feature_node.h"
#include "sim_node/collision/layers/lanes.h"

namespace tactus::sim::features {
namespace {

// A connection may deviate from the allowed directions by this much, rad; see kDirectionSlack_rad.
constexpr float kOutward = 0.02f;
// Squared sine below which the common perpendicular of two edges is unreliable in float.
constexpr float kNearlyParallelEdges = 1e-4f;

inline __attribute__((always_inline)) void least(const Floats& x, const Floats& y, Floats& out) {
  out = x < y ? x : y;
}

inline __attribute__((always_inline)) unsigned used_lanes(int count, int first) {
  return (1u << (count - first < kStep ? count - first : kStep)) - 1;
}

inline __attribute__((always_inline)) unsigned reach_from(const FeatureNode& n, const FeatureQuery& q, int first) {
  Floats d[3], x, y, z, size, squared, r, far;
  for (int k = 0; k < 3; ++k) {
    load(n.centre[k] + first, x);
    d[k] = q.centre[k] - x;
  }
  squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  load(n.size + first, size);
  r = size + (q.size + q.slack);
  far = r + q.reach;
  Ints apart = squared > far * far;
  // The cones: opposite directions, and the connection of the centres within the query's cone.
  Floats cosine, sine, across, high;
  load(n.cosine + first, cosine);
  load(n.sine + first, sine);
  load(n.cone[0] + first, x);
  load(n.cone[1] + first, y);
  load(n.cone[2] + first, z);
  across = x * q.cone[0] + y * q.cone[1] + z * q.cone[2];
  magnitude(across, across);
  apart |= across < cosine * q.cosine - sine * q.sine - 1e-5f;
  high = d[0] * q.cone[0] + d[1] * q.cone[1] + d[2] * q.cone[2];
  magnitude(high, high);
  far = r + high * q.sine;
  apart |= (squared - high * high) * (q.cosine * q.cosine) > far * far;
  const unsigned used = used_lanes(n.count, first);
  if ((signs(apart) & used) == used) return 0;
  // The box, extended along the directions of its features. Axis 2 first: it bounds the distance.
  Floats height, along[3], out[3];
  for (int i = 0; i < 3; ++i) {
    Floats half;
    load(n.axis[i][0] + first, x);
    load(n.axis[i][1] + first, y);
    load(n.axis[i][2] + first, z);
    along[i] = x * d[0] + y * d[1] + z * d[2];
    magnitude(along[i], along[i]);
    out[i] = x * q.along[0] + y * q.along[1] + z * q.along[2];
    magnitude(out[i], out[i]);
    load(n.half[i] + first, half);
    out[i] += half + (q.radius + q.slack);
  }
  load(n.per_rise + first, x);
  height = (along[2] + out[2]) * x;
  y = height - height + q.reach;
  least(height, y, height);
  for (int i = 0; i < 3; ++i) {
    load(n.slope[i] + first, x);
    apart |= along[i] > out[i] + height * x;
  }
  return ~signs(apart) & used;
}

inline __attribute__((always_inline)) void cross(const Floats* a, const float* b, Floats* out) {
  for (int k = 0; k < 3; ++k) {
    const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    out[k] = a[k1] * b[k2] - a[k2] * b[k1];
  }
}

inline __attribute__((always_inline)) unsigned cross_from(const FeatureNode& n, const EdgeLanes& e,
                                                          const EdgeQuery& q, int first) {
  Floats d[3], u[3], normal[3], x[3], half, squared, sine, apart_by, limit, t;
  for (int k = 0; k < 3; ++k) {
    load(n.centre[k] + first, d[k]);
    d[k] = d[k] - q.centre[k];
    load(e.along[k] + first, u[k]);
  }
  load(e.half + first, half);
  cross(u, q.along, normal);  // minus the common perpendicular of the formulas
  for (int k = 0; k < 3; ++k) normal[k] = -normal[k];
  squared = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  root(squared, sine);
  const Ints parallel = squared < kNearlyParallelEdges;
  t = normal[0] * d[0] + normal[1] * d[1] + normal[2] * d[2];
  magnitude(t, apart_by);
  // Rounding: 1e-7 of the distance of the middles, which is at most the reach and both halves.
  Floats rounding = (half + (q.half + q.reach)) * 1e-6f + q.slack;
  Ints apart = apart_by > sine * q.reach + rounding;
  const Ints sure = apart_by > rounding;
  limit = sine * kOutward + 2e-6f;
  for (int side = 0; side < 2; ++side) {
    Floats own, other, y;
    own = normal[0] * q.inward[side][0] + normal[1] * q.inward[side][1] + normal[2] * q.inward[side][2];
    apart |= sure & (((t > 0.0f) & (own > limit)) | ((t < 0.0f) & (-own > limit)));
    other = own - own;
    for (int k = 0; k < 3; ++k) {
      load(e.inward[side][k] + first, y);
      other += normal[k] * y;
    }
    apart |= sure & (((t > 0.0f) & (-other > limit)) | ((t < 0.0f) & (other > limit)));
  }
  // Nearest points of the lines, from the middles: det(d, other edge, normal) / normal^2.
  Floats place;
  for (int k = 0; k < 3; ++k) {
    const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    x[k] = d[k1] * u[k2] - d[k2] * u[k1];
  }
  place = x[0] * normal[0] + x[1] * normal[1] + x[2] * normal[2];
  magnitude(place, place);
  apart |= place > squared * (q.half + q.slack) + rounding;
  cross(d, q.along, x);
  place = x[0] * normal[0] + x[1] * normal[1] + x[2] * normal[2];
  magnitude(place, place);
  apart |= place > squared * (half + q.slack) + rounding;
  return (~signs(apart) | signs(parallel)) & used_lanes(n.count, first);
}

inline __attribute__((always_inline)) unsigned reach(const FeatureNode& n, const FeatureQuery& q) {
  unsigned hit = reach_from(n, q, 0);
  for (int first = kStep; first < n.count; first += kStep) hit |= reach_from(n, q, first) << first;
  return hit;
}

inline __attribute__((always_inline)) unsigned cross_edges(const FeatureNode& n, const EdgeLanes& e,
                                                           const EdgeQuery& q) {
  unsigned hit = cross_from(n, e, q, 0);
  for (int first = kStep; first < n.count; first += kStep) hit |= cross_from(n, e, q, first) << first;
  return hit;
}

}  // namespace
}  // namespace tactus::sim::features
