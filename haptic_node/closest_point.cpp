#include "haptic_node/closest_point.h"

#include <Eigen/LU>
#include <algorithm>

namespace tactus::haptic {
namespace {

// A nanometre: far below what a hand or a device resolves, far above rounding in a room.
constexpr double kTolerance_m = 1e-9;
// Sets whose normals span less (square of the volume) count as dependent: two planes 0.0001 rad apart are one.
constexpr double kIndependent = 1e-8;

// The problem in coordinates around the goal: find x with normal_i . x >= deficit_i, least |x|.
struct Problem {
  std::array<Eigen::Vector3d, kMaxHalfSpaces> normal;
  std::array<double, kMaxHalfSpaces> deficit;
  std::size_t size = 0;

  bool allows(const Eigen::Vector3d& x) const {
    for (std::size_t i = 0; i < size; ++i)
      if (normal[i].dot(x) < deficit[i] - kTolerance_m) return false;
    return true;
  }
};

template <int N>
bool try_set(const Problem& p, const std::array<std::size_t, N>& set, ClosestPoint& out) {
  Eigen::Matrix<double, N, 3> normals;
  Eigen::Matrix<double, N, 1> deficits;
  for (int k = 0; k < N; ++k) {
    normals.row(k) = p.normal[set[k]];
    deficits[k] = p.deficit[set[k]];
  }
  const Eigen::Matrix<double, N, N> gram = normals * normals.transpose();
  if (gram.determinant() < kIndependent) return false;
  const Eigen::Matrix<double, N, 1> multipliers = gram.inverse() * deficits;
  if (multipliers.minCoeff() < 0) return false;
  const Eigen::Vector3d x = normals.transpose() * multipliers;
  if (!p.allows(x)) return false;
  out.point = x;
  for (int k = 0; k < N; ++k) out.multiplier[set[k]] = multipliers[k];
  return true;
}

bool try_all_sets(const Problem& p, ClosestPoint& out) {
  const std::size_t n = p.size;
  for (std::size_t a = 0; a < n; ++a)
    if (try_set<1>(p, {a}, out)) return true;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b)
      if (try_set<2>(p, {a, b}, out)) return true;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b)
      for (std::size_t c = b + 1; c < n; ++c)
        if (try_set<3>(p, {a, b, c}, out)) return true;
  return false;
}

// No common point: let every half space yield by multiplier times kSoftness, which has a solution for any region,
// found by Hildreth's dual coordinate ascent (1957) in a fixed number of sweeps.
void compromise(const Problem& p, ClosestPoint& out) {
  constexpr double kSoftness = 0.02;
  constexpr int kSweeps = 200;
  out.feasible = false;
  out.point.setZero();
  std::array<double, kMaxHalfSpaces> dual{};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 0; i < p.size; ++i) {
      const double residual = p.deficit[i] - p.normal[i].dot(out.point) - kSoftness * dual[i];
      const double next = std::max(0.0, dual[i] + residual / (1 + kSoftness));
      out.point += (next - dual[i]) * p.normal[i];
      dual[i] = next;
    }
  }
  // The duals of opposed walls balance each other at any size; as forces they would crush what is between.
  for (std::size_t i = 0; i < p.size; ++i) out.multiplier[i] = std::max(0.0, p.deficit[i]);
}

}  // namespace

ClosestPoint closest_point(std::span<const HalfSpace> region, const Eigen::Vector3d& goal) {
  Problem p;
  p.size = std::min(region.size(), kMaxHalfSpaces);
  for (std::size_t i = 0; i < p.size; ++i) {
    p.normal[i] = region[i].normal;
    p.deficit[i] = region[i].offset - region[i].normal.dot(goal);
  }
  ClosestPoint out;
  if (!p.allows(Eigen::Vector3d::Zero()) && !try_all_sets(p, out)) compromise(p, out);
  out.point += goal;
  return out;
}

}  // namespace tactus::haptic
