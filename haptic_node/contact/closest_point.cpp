#include "haptic_node/contact/closest_point.h"

#include <Eigen/LU>
#include <algorithm>

namespace tactus::haptic {
namespace {

// A nanometre: far below the resolution of a hand or a device, far above rounding errors in a room.
constexpr double kTolerance_m = 1e-9;
// Sets whose normals span less (square of area or volume) count as dependent. Rounding would be a thousandth of
// the result: for two planes at 1e-6 rad, for three at 1e-5 rad.
constexpr double kIndependent = 1e-20;
// Violation that may remain where only dependent sets exist: 1 mN at 1 N/mm (design).
constexpr double kNegligible_m = 1e-6;

// Half spaces in coordinates about the goal: find x with normal_i . x >= deficit_i, least |x|.
template <std::size_t Capacity>
struct Problem {
  std::array<Eigen::Vector3d, Capacity> normal;
  std::array<double, Capacity> deficit;
  std::size_t size = 0;

  bool allows(const Eigen::Vector3d& x) const {
    for (std::size_t i = 0; i < size; ++i)
      if (normal[i].dot(x) < deficit[i] - kTolerance_m) return false;
    return true;
  }
};
using Region = Problem<kMaxHalfSpaces>;

// The binding half spaces, at most three, and the point that they determine.
struct Basis {
  std::array<std::size_t, 3> member{};
  std::array<double, 3> multiplier{};
  std::size_t size = 0;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
};

// Four half spaces: those that bound the point so far, and last the one that it violates.
using Candidates = Problem<4>;

template <int N>
bool try_set(const Candidates& c, const std::array<std::size_t, N>& set, Basis& out) {
  Eigen::Matrix<double, N, 3> normals;
  Eigen::Matrix<double, N, 1> deficits;
  for (int k = 0; k < N; ++k) {
    normals.row(k) = c.normal[set[k]];
    deficits[k] = c.deficit[set[k]];
  }
  Eigen::Matrix<double, N, 1> multipliers;
  Eigen::Vector3d x;
  if constexpr (N == 3) {
    // Uses the normals themselves: the product of the matrix and its transpose would square the error.
    const double volume = normals.determinant();
    if (volume * volume < kIndependent) return false;
    const Eigen::Matrix3d inverse = normals.inverse();
    x = inverse * deficits;
    multipliers = inverse.transpose() * x;
  } else {
    const Eigen::Matrix<double, N, N> gram = normals * normals.transpose();
    if (gram.determinant() < kIndependent) return false;
    multipliers = gram.inverse() * deficits;
    x = normals.transpose() * multipliers;
  }
  if (multipliers.minCoeff() < 0) return false;
  if (!c.allows(x)) return false;
  out.x = x;
  out.size = N;
  for (std::size_t k = 0; k < N; ++k) out.member[k] = set[k], out.multiplier[k] = multipliers[static_cast<int>(k)];
  return true;
}

// The best point of the others violates the last candidate, so it is among the binding ones.
bool try_all_sets(const Candidates& c, Basis& out) {
  const std::size_t last = c.size - 1;
  if (try_set<1>(c, {last}, out)) return true;
  for (std::size_t a = 0; a < last; ++a)
    if (try_set<2>(c, {a, last}, out)) return true;
  for (std::size_t a = 0; a < last; ++a)
    for (std::size_t b = a + 1; b < last; ++b)
      if (try_set<3>(c, {a, b, last}, out)) return true;
  return false;
}

std::size_t max_violation_index(const Region& region, const Eigen::Vector3d& x) {
  std::size_t worst = region.size;
  double violation = kTolerance_m;
  for (std::size_t i = 0; i < region.size; ++i) {
    const double by = region.deficit[i] - region.normal[i].dot(x);
    if (by > violation) violation = by, worst = i;
  }
  return worst;
}

bool exchange(const Region& region, ClosestPoint& out) {
  // Each exchange increases the distance from the goal; more than this number is a cycle caused by rounding.
  constexpr std::size_t kMaxExchanges = 2 * kMaxHalfSpaces;
  Basis basis;
  double violation = 0;
  for (std::size_t iteration = 0; iteration < kMaxExchanges; ++iteration) {
    const std::size_t worst = max_violation_index(region, basis.x);
    violation = worst < region.size ? region.deficit[worst] - region.normal[worst].dot(basis.x) : 0;
    if (violation <= 0) break;
    std::array<std::size_t, 4> number{};
    Candidates c;
    for (std::size_t k = 0; k < basis.size; ++k) number[c.size++] = basis.member[k];
    number[c.size++] = worst;
    for (std::size_t k = 0; k < c.size; ++k) {
      c.normal[k] = region.normal[number[k]];
      c.deficit[k] = region.deficit[number[k]];
    }
    // Helly: if four have no common point, all have none.
    if (!try_all_sets(c, basis)) break;
    for (std::size_t k = 0; k < basis.size; ++k) basis.member[k] = number[basis.member[k]];
  }
  if (violation > kNegligible_m) return false;
  out.point = basis.x;
  for (std::size_t k = 0; k < basis.size; ++k) out.multiplier[basis.member[k]] = basis.multiplier[k];
  return true;
}

// No common point: every half space yields as a spring does. This has one solution for any region: the minimum of
// |x|^2 + sum violation_i^2 / kSoftness, a convex function of three variables with a piecewise linear gradient.
// Newton's method with halved steps finds it in a few iterations, exactly (Mangasarian 2002, for such functions).
void compromise(const Region& region, ClosestPoint& out) {
  constexpr double kSoftness = 0.02;
  constexpr int kMaxIterations = 30, kHalvings = 20;
  const auto value = [&](const Eigen::Vector3d& x) {
    double sum = x.squaredNorm();
    for (std::size_t i = 0; i < region.size; ++i) {
      const double by = std::max(0.0, region.deficit[i] - region.normal[i].dot(x));
      sum += by * by / kSoftness;
    }
    return sum;
  };
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  double cost = value(x);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Eigen::Matrix3d slope = kSoftness * Eigen::Matrix3d::Identity();
    Eigen::Vector3d pull = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < region.size; ++i) {
      if (region.normal[i].dot(x) >= region.deficit[i]) continue;
      slope += region.normal[i] * region.normal[i].transpose();
      pull += region.deficit[i] * region.normal[i];
    }
    Eigen::Vector3d step = slope.inverse() * pull - x;
    if (step.norm() < kTolerance_m) break;
    double next = value(x + step);
    for (int k = 0; k < kHalvings && next > cost; ++k) {
      step *= 0.5;
      next = value(x + step);
    }
    if (next > cost) break;
    x += step;
    cost = next;
  }
  out.feasible = false;
  out.point = x;
  // The springs of opposed walls balance each other at any size; as forces they would crush the body between them.
  for (std::size_t i = 0; i < region.size; ++i) out.multiplier[i] = std::max(0.0, region.deficit[i]);
}

}  // namespace

ClosestPoint closest_point(std::span<const HalfSpace> region, const Eigen::Vector3d& goal) {
  Region p;
  p.size = std::min(region.size(), kMaxHalfSpaces);
  for (std::size_t i = 0; i < p.size; ++i) {
    p.normal[i] = region[i].normal;
    p.deficit[i] = region[i].offset - region[i].normal.dot(goal);
  }
  ClosestPoint out;
  if (!exchange(p, out)) compromise(p, out);
  out.point += goal;
  return out;
}

}  // namespace tactus::haptic
