#include "haptic_node/contact/pose_qp.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

namespace tactus::haptic {
namespace {

// The same tolerance as for points (closest_point.cpp): far below the resolution of a hand, far above rounding
// errors in a room.
constexpr double kPoseTolerance_m = 1e-9;
// Violation that may remain where only dependent sets exist: 1 mN at 1 N/mm (design).
constexpr double kNegligibleDepth_m = 1e-6;
// A unit normal whose part outside the span of the others is shorter counts as dependent.
constexpr double kIndependentPart = 1e-6;

// The half spaces in coordinates about the goal, with normals of length 1.
struct PoseProblem {
  std::array<Vector6, kMaxHalfSpaces> normal;
  std::array<double, kMaxHalfSpaces> deficit;
  std::size_t size = 0;

  std::size_t max_violation_index(const Vector6& x) const {
    std::size_t worst = size;
    double violation = kPoseTolerance_m;
    for (std::size_t i = 0; i < size; ++i) {
      const double by = deficit[i] - normal[i].dot(x);
      if (by > violation) violation = by, worst = i;
    }
    return worst;
  }
};

struct State {
  Vector6 x = Vector6::Zero();
  BindingSet set;
  std::array<double, 6> u{};

  void drop(std::size_t k) {
    for (std::size_t j = k; j + 1 < set.size(); ++j) u[j] = u[j + 1];
    set.drop(k);
  }
};

// Adds half space p and removes those that block it. Returns false when p and the binding ones have no common
// pose.
bool add_constraint(const PoseProblem& problem, std::size_t p, State& s) {
  double own = 0;  // multiplier of p
  for (int iteration = 0; iteration <= 6; ++iteration) {
    const Vector6& n = problem.normal[p];
    const std::array<double, 6> r = s.set.coefficients(n);
    const Vector6 z = s.set.free_part(n);
    std::size_t blocking = s.set.size();
    double dual = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < s.set.size(); ++k)
      if (r[k] > 0 && s.u[k] / r[k] < dual) dual = s.u[k] / r[k], blocking = k;
    const bool moves = s.set.size() < 6 && z.norm() > kIndependentPart;
    const double primal =
        moves ? (problem.deficit[p] - n.dot(s.x)) / z.squaredNorm() : std::numeric_limits<double>::infinity();
    const double step = std::min(dual, primal);
    if (step == std::numeric_limits<double>::infinity()) return false;
    if (moves) s.x += step * z;
    for (std::size_t k = 0; k < s.set.size(); ++k) s.u[k] = std::max(0.0, s.u[k] - step * r[k]);
    own += step;
    if (primal <= dual) {
      const std::size_t at = s.set.size();
      if (!s.set.add(p, n)) return false;
      s.u[at] = own;
      return true;
    }
    s.drop(blocking);
  }
  return false;
}

bool solve(const PoseProblem& problem, State& s) {
  // A larger number of iterations is a cycle caused by rounding.
  constexpr std::size_t kMaxIterations = 3 * kMaxHalfSpaces;
  for (std::size_t iteration = 0; iteration < kMaxIterations; ++iteration) {
    const std::size_t worst = problem.max_violation_index(s.x);
    if (worst == problem.size) return true;
    if (!add_constraint(problem, worst, s)) break;
  }
  const std::size_t worst = problem.max_violation_index(s.x);
  return worst == problem.size || problem.deficit[worst] - problem.normal[worst].dot(s.x) <= kNegligibleDepth_m;
}

// Used when there is no common pose: every half space yields like a spring (closest_point.cpp).
Vector6 compromise(const PoseProblem& problem) {
  constexpr double kSoftness = 0.02;
  constexpr int kMaxIterations = 30, kHalvings = 20;
  const auto value = [&](const Vector6& x) {
    double sum = x.squaredNorm();
    for (std::size_t i = 0; i < problem.size; ++i) {
      const double by = std::max(0.0, problem.deficit[i] - problem.normal[i].dot(x));
      sum += by * by / kSoftness;
    }
    return sum;
  };
  Vector6 x = Vector6::Zero();
  double cost = value(x);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Eigen::Matrix<double, 6, 6> slope = kSoftness * Eigen::Matrix<double, 6, 6>::Identity();
    Vector6 pull = Vector6::Zero();
    for (std::size_t i = 0; i < problem.size; ++i) {
      if (problem.normal[i].dot(x) >= problem.deficit[i]) continue;
      slope += problem.normal[i] * problem.normal[i].transpose();
      pull += problem.deficit[i] * problem.normal[i];
    }
    Vector6 step = slope.llt().solve(pull) - x;
    if (step.norm() < kPoseTolerance_m) break;
    double next = value(x + step);
    for (int k = 0; k < kHalvings && next > cost; ++k) {
      step *= 0.5;
      next = value(x + step);
    }
    if (next > cost) break;
    x += step;
    cost = next;
  }
  return x;
}

}  // namespace

Vector6 BindingSet::free_part(const Vector6& v) const {
  Vector6 z = v;
  // Twice: the second pass removes the rounding of the first.
  for (int pass = 0; pass < 2; ++pass)
    for (std::size_t k = 0; k < size_; ++k) z -= basis_[k].dot(z) * basis_[k];
  return z;
}

std::array<double, 6> BindingSet::coefficients(const Vector6& v) const {
  std::array<double, 6> c{};
  for (std::size_t k = size_; k-- > 0;) {
    double sum = basis_[k].dot(v);
    for (std::size_t j = k + 1; j < size_; ++j) sum -= triangle_[k][j] * c[j];
    c[k] = sum / triangle_[k][k];
  }
  return c;
}

std::array<double, 6> BindingSet::shares(const std::array<double, 6>& rates) const {
  Vector6 v = Vector6::Zero();  // the least motion that has these rates
  std::array<double, 6> y{};
  for (std::size_t k = 0; k < size_; ++k) {
    y[k] = rates[k];
    for (std::size_t j = 0; j < k; ++j) y[k] -= triangle_[j][k] * y[j];
    y[k] /= triangle_[k][k];
    v += y[k] * basis_[k];
  }
  return coefficients(v);
}

bool BindingSet::add(std::size_t index, const Vector6& normal) {
  if (size_ >= 6) return false;
  const Vector6 z = free_part(normal);
  const double length = z.norm();
  if (!(length > kIndependentPart * normal.norm())) return false;
  for (std::size_t k = 0; k < size_; ++k) triangle_[k][size_] = basis_[k].dot(normal);
  triangle_[size_][size_] = length;
  basis_[size_] = z / length;
  normal_[size_] = normal;
  member_[size_] = index;
  ++size_;
  return true;
}

void BindingSet::drop(std::size_t k) {
  const std::size_t old = size_;
  size_ = k;
  for (std::size_t j = k + 1; j < old; ++j) {
    const Vector6 normal = normal_[j];
    add(member_[j], normal);
  }
}

bool distribute(std::span<const PoseHalfSpace> region, std::span<const double> weights, const Vector6& sum,
                std::span<double> shares) {
  constexpr int kMaxIterations = 8;
  constexpr double kRounding = 1e-11, kExact = 1e-6;
  const std::size_t n = std::min({region.size(), weights.size(), shares.size(), kMaxHalfSpaces});
  std::array<double, kMaxHalfSpaces> weight{}, found{};
  std::copy_n(weights.begin(), n, weight.begin());
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Eigen::Matrix<double, 6, 6> gram = Eigen::Matrix<double, 6, 6>::Zero();
    for (std::size_t i = 0; i < n; ++i)
      if (weight[i] > 0) gram += weight[i] * region[i].normal * region[i].normal.transpose();
    const double size = gram.trace();
    if (!(size > 0)) return false;
    gram.diagonal().array() += kRounding * size;
    const Eigen::LLT<Eigen::Matrix<double, 6, 6>> solver(gram);
    Vector6 lambda = solver.solve(sum);
    double worst = 0;
    std::size_t negative = n;
    Vector6 rest = sum;
    for (std::size_t i = 0; i < n; ++i) {
      found[i] = weight[i] > 0 ? weight[i] * region[i].normal.dot(lambda) : 0;
      rest -= found[i] * region[i].normal;
      if (found[i] < worst) worst = found[i], negative = i;
    }
    if (negative < n) {
      weight[negative] = 0;
      continue;
    }
    if (!(rest.norm() <= kExact * sum.norm())) return false;
    std::copy_n(found.begin(), n, shares.begin());
    return true;
  }
  return false;
}

ClosestPose closest_pose(std::span<const PoseHalfSpace> region, const Vector6& goal) {
  PoseProblem p;
  p.size = std::min(region.size(), kMaxHalfSpaces);
  std::array<double, kMaxHalfSpaces> length;
  for (std::size_t i = 0; i < p.size; ++i) {
    length[i] = region[i].normal.norm();
    p.normal[i] = region[i].normal / length[i];
    p.deficit[i] = (region[i].offset - region[i].normal.dot(goal)) / length[i];
  }
  ClosestPose out;
  State s;
  if (!solve(p, s)) {
    out.feasible = false;
    out.pose = goal + compromise(p);
    return out;
  }
  // The binding set is known: solves again from scratch, without the accumulated rounding.
  std::array<double, 6> rates{};
  for (std::size_t k = 0; k < s.set.size(); ++k) rates[k] = p.deficit[s.set.member(k)];
  const std::array<double, 6> u = s.set.shares(rates);
  out.pose = goal;
  for (std::size_t k = 0; k < s.set.size(); ++k) {
    const std::size_t i = s.set.member(k);
    const double size = std::max(0.0, u[k]);
    out.pose += size * p.normal[i];
    out.multiplier[i] = size / length[i];
    out.binding.add(i, region[i].normal);
  }
  return out;
}

}  // namespace tactus::haptic
