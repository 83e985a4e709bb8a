#include "sim_node/behaviour/impulse/island_solver.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim::impulse {
namespace {

// Largest island that is solved as a whole, in points, and the largest sum of squares of points in a step: bounds the
// time of a step. Design values: a tower of ten boxes, and four of them.
constexpr int kMaxPoints = 44;
constexpr int kMaxWork = 4 * kMaxPoints * kMaxPoints;
constexpr int kMaxIterations = 24, kFullSteps = 14;
constexpr double kLeastShare = 0.01;  // of a Newton step
// Share of a point's own mobility that is added to the matrix of a Newton step, so that redundant points (four corners
// of a face) leave it regular. The result is not changed by it.
constexpr double kRegular = 1e-9;
// Rounding of energies, as a share of the energy that the impulses take and return.
constexpr double kEnergyRounding = 1e-12;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Moves an impulse into the friction cone along the tangents.
void project(const ContactPoint& p, double* impulse) {
  impulse[0] = std::max(0.0, impulse[0]);
  const double size = std::hypot(impulse[1], impulse[2]), limit = p.friction * impulse[0];
  if (size <= limit) return;
  impulse[1] *= limit / size, impulse[2] *= limit / size;
}

}  // namespace

int IslandSolver::root(int mover) {
  while (root_[at(mover)] != mover) mover = root_[at(mover)] = root_[at(root_[at(mover)])];
  return mover;
}

void IslandSolver::find_islands(const ContactRows& rows, std::span<const JointRow> joints, int movers) {
  root_.resize(at(movers));
  for (const ContactGroup& g : rows.groups)
    for (const int m : {g.mover_a, g.mover_b})
      if (m >= 0) root_[at(m)] = m;
  for (const JointRow& row : joints) root_[at(row.mover)] = row.mover;
  for (const ContactGroup& g : rows.groups)
    if (g.mover_a >= 0 && g.mover_b >= 0) root_[at(root(g.mover_a))] = root(g.mover_b);
  islands_.clear();
  island_of_.assign(at(movers), -1);
  const auto mover_of = [](const ContactGroup& g) { return g.mover_a >= 0 ? g.mover_a : g.mover_b; };
  for (const ContactGroup& g : rows.groups) {
    int& island = island_of_[at(root(mover_of(g)))];
    if (island < 0) {
      island = static_cast<int>(islands_.size());
      islands_.emplace_back();
    }
    islands_[at(island)].count += g.count;
  }
  for (const JointRow& row : joints)
    if (const int island = island_of_[at(root(row.mover))]; island >= 0) islands_[at(island)].has_joints = true;
  int first = 0;
  for (Island& i : islands_) {
    i.first = first;
    first += i.count;
    i.count = 0;
  }
  points_.resize(at(first));
  for (const ContactGroup& g : rows.groups) {
    Island& island = islands_[at(island_of_[at(root(mover_of(g)))])];
    for (int i = 0; i < g.count; ++i) points_[at(island.first + island.count++)] = g.first + i;
  }
}

double IslandSolver::residual_m_s(const ContactRows& rows, std::span<const int> points, const Velocities& velocity) const {
  double worst = 0;
  for (const int i : points) {
    const ContactPoint& p = rows.points[at(i)];
    Vector3d v = rows.velocity(p, velocity);
    v.x() -= p.min_speed_m_s;
    const Vector3d by = ContactRows::solve_point(p, p.impulse, v) - p.impulse;
    worst = std::max(worst, by.cwiseAbs().maxCoeff() * p.mobility(0, 0));
  }
  return worst;
}

// Sets the matrix of the island, and the velocities that its points have without impulses.
void IslandSolver::build(const ContactRows& rows, std::span<const int> points, const Velocities& velocity) {
  n_ = 3 * points.size();
  matrix_.assign(n_ * n_, 0);
  free_.resize(n_);
  impulse_.resize(n_);
  unit_.twists.resize(velocity.twists.size());
  unit_.rates.assign(velocity.rates.size(), 0);
  for (std::size_t j = 0; j < points.size(); ++j) {
    const ContactPoint& q = rows.points[at(points[j])];
    for (int axis = 0; axis < 3; ++axis) {
      Vector3d push = Vector3d::Zero();
      push[axis] = 1;
      unit_.twists[at(q.a)] = unit_.twists[at(q.b)] = {};
      rows.apply(q, push, unit_);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const ContactPoint& p = rows.points[at(points[i])];
        const auto shares = [&](int m) { return m > 0 && (m == q.mover_a || m == q.mover_b); };
        if (!shares(p.mover_a) && !shares(p.mover_b)) continue;
        const Vector3d v = rows.velocity(p, unit_);
        for (int r = 0; r < 3; ++r) matrix_[(3 * i + at(r)) * n_ + 3 * j + at(axis)] = v[r];
      }
      unit_.twists[at(q.a)] = unit_.twists[at(q.b)] = {};
      for (int c = 0; c < q.couplings; ++c) {
        const Coupling& k = rows.couplings[at(q.first_coupling + c)];
        std::fill_n(unit_.rates.begin() + static_cast<std::ptrdiff_t>(k.first_rate), k.rates, 0.0);
      }
    }
    for (int r = 0; r < 3; ++r) impulse_[3 * j + at(r)] = q.impulse[r];
  }
  // A point moves with the points that share a body with it: most of a row is zero.
  filled_.assign(n_, {0, n_});
  for (std::size_t i = 0; i < n_; ++i) {
    const double* row = matrix_.data() + i * n_;
    auto& [first, end] = filled_[i];
    while (first < end && row[first] == 0) ++first;
    while (end > first && row[end - 1] == 0) --end;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ContactPoint& p = rows.points[at(points[i])];
    Vector3d v = rows.velocity(p, velocity);
    v.x() -= p.min_speed_m_s;
    for (int r = 0; r < 3; ++r) {
      const double* row = matrix_.data() + (3 * i + at(r)) * n_;
      double sum = v[r];
      for (std::size_t k = 0; k < n_; ++k) sum -= row[k] * impulse_[k];
      free_[3 * i + at(r)] = sum;
    }
  }
}

// Sets speed_; returns the largest change that another sweep would make.
double IslandSolver::residual_of(const ContactRows& rows, std::span<const int> points, const std::vector<double>& impulse) {
  speed_.resize(n_);
  for (std::size_t i = 0; i < n_; ++i) {
    const double* row = matrix_.data() + i * n_;
    double sum = free_[i];
    for (std::size_t k = filled_[i].first; k < filled_[i].second; ++k) sum += row[k] * impulse[k];
    speed_[i] = sum;
  }
  double worst = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ContactPoint& p = rows.points[at(points[i])];
    const Vector3d x = Eigen::Map<const Vector3d>(impulse.data() + 3 * i), v = Eigen::Map<const Vector3d>(speed_.data() + 3 * i);
    const Vector3d by = ContactRows::solve(p, x, v) - x;
    worst = std::max(worst, by.cwiseAbs().maxCoeff() * p.mobility(0, 0));
  }
  return worst;
}

// The rows of a Newton step at impulse_ and speed_: jacobian_ * step_ = -residual, with the residual in step_.
void IslandSolver::linearise(const ContactRows& rows, std::span<const int> points) {
  jacobian_.assign(n_ * n_, 0);
  step_.resize(n_);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ContactPoint& p = rows.points[at(points[i])];
    const double r = 1 / p.mobility(0, 0), rt = 1 / p.sliding_mobility;
    const double *x = impulse_.data() + 3 * i, *u = speed_.data() + 3 * i;
    const auto target = [&](int k) { return jacobian_.data() + (3 * i + at(k)) * n_; };
    const auto source = [&](int k) { return matrix_.data() + (3 * i + at(k)) * n_; };
    const double normal = x[0] - r * u[0];
    if (normal <= 0) {
      for (int k = 0; k < 3; ++k) {
        target(k)[3 * i + at(k)] = 1;
        step_[3 * i + at(k)] = -x[k];
      }
      continue;
    }
    const auto at_rest = [&](int k, double scale) {
      for (std::size_t j = 0; j < n_; ++j) target(k)[j] = scale * source(k)[j];
      target(k)[3 * i + at(k)] += kRegular;
      step_[3 * i + at(k)] = -scale * u[k];
    };
    at_rest(0, r);
    const double y = x[1] - rt * u[1], z = x[2] - rt * u[2], size = std::hypot(y, z), limit = p.friction * normal;
    if (size <= limit) {
      at_rest(1, rt);
      at_rest(2, rt);
      continue;
    }
    const double d[2] = {y / size, z / size};
    for (int k = 0; k < 2; ++k) {
      double* row = target(k + 1);
      row[3 * i + at(k + 1)] += 1;
      // - friction * direction * change of the normal impulse.
      const double along = p.friction * d[k];
      row[3 * i] -= along;
      for (std::size_t j = 0; j < n_; ++j) row[j] += along * r * source(0)[j];
      // - limit * change of the direction.
      for (int l = 0; l < 2; ++l) {
        const double turn = limit * ((k == l ? 1.0 : 0.0) - d[k] * d[l]) / size;
        row[3 * i + at(l + 1)] -= turn;
        for (std::size_t j = 0; j < n_; ++j) row[j] += turn * rt * source(l + 1)[j];
      }
      step_[3 * i + at(k + 1)] = -(x[k + 1] - limit * d[k]);
    }
  }
}

// Solves jacobian_ * step_ = step_ in place, by elimination with row pivots. Returns false when it is singular. Points
// that share no body leave zeros, so that most rows of a tower end early.
bool IslandSolver::eliminate() {
  const std::size_t n = n_;
  end_.resize(n);
  for (std::size_t r = 0; r < n; ++r) {
    const double* row = jacobian_.data() + r * n;
    end_[r] = n;
    while (end_[r] > 0 && row[end_[r] - 1] == 0) --end_[r];
  }
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < n; ++r)
      if (std::abs(jacobian_[r * n + c]) > std::abs(jacobian_[pivot * n + c])) pivot = r;
    const double largest = jacobian_[pivot * n + c];
    if (!(std::abs(largest) > 1e-14)) return false;
    if (pivot != c) {
      std::swap_ranges(jacobian_.begin() + static_cast<std::ptrdiff_t>(c * n), jacobian_.begin() + static_cast<std::ptrdiff_t>((c + 1) * n),
                       jacobian_.begin() + static_cast<std::ptrdiff_t>(pivot * n));
      std::swap(step_[c], step_[pivot]);
      std::swap(end_[c], end_[pivot]);
    }
    const double* top = jacobian_.data() + c * n;
    for (std::size_t r = c + 1; r < n; ++r) {
      double* row = jacobian_.data() + r * n;
      if (row[c] == 0) continue;
      const double share = row[c] / largest;
      for (std::size_t k = c + 1; k < end_[c]; ++k) row[k] -= share * top[k];
      end_[r] = std::max(end_[r], end_[c]);
      step_[r] -= share * step_[c];
    }
  }
  for (std::size_t c = n; c-- > 0;) {
    double sum = step_[c];
    for (std::size_t k = c + 1; k < end_[c]; ++k) sum -= jacobian_[c * n + k] * step_[k];
    step_[c] = sum / jacobian_[c * n + c];
    if (!std::isfinite(step_[c])) return false;
  }
  return true;
}

// Newton's method from the impulses of the sweeps. Keeps the best impulses found; returns whether they are better.
bool IslandSolver::solve(ContactRows& rows, std::span<const int> points, double settled, Velocities& velocity) {
  build(rows, points, velocity);
  best_ = impulse_;
  const double begun = residual_of(rows, points, impulse_);
  double least = begun, now = begun;
  for (int iteration = 0; iteration < kMaxIterations && least > settled; ++iteration) {
    // Whole steps find most solutions, also through worse ones and through impulses outside the cones. Then shorter ones
    // from the best impulses found.
    const bool whole = iteration < kFullSteps;
    if (iteration == kFullSteps) {
      impulse_ = best_;
      now = residual_of(rows, points, impulse_);
    }
    linearise(rows, points);
    if (!eliminate()) break;
    double next = 0;
    for (double share = 1; share > kLeastShare; share /= 2) {
      trial_ = impulse_;
      for (std::size_t i = 0; i < n_; ++i) trial_[i] += share * step_[i];
      if (whole) impulse_ = trial_;
      for (std::size_t i = 0; i < points.size(); ++i) project(rows.points[at(points[i])], trial_.data() + 3 * i);
      next = residual_of(rows, points, trial_);
      if (whole || next < now) break;
    }
    if (next < least) {
      least = next;
      best_ = trial_;
    }
    if (whole) {
      residual_of(rows, points, impulse_);  // speed_ of the next step
    } else {
      if (next >= now) break;
      impulse_ = trial_;
      now = next;
    }
  }
  if (!(least < begun)) return false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ContactPoint& p = rows.points[at(points[i])];
    const Vector3d next = Eigen::Map<const Vector3d>(best_.data() + 3 * i), by = next - p.impulse;
    p.impulse = next;
    rows.apply(p, by, velocity);
  }
  return true;
}

// With impulses scaled by s the kinetic energy changes by s w + s^2 q / 2, where w is the sum of impulse times
// velocity without them, and q that of impulse times the velocity that they add. The change is at most zero up to
// s = -2 w / q. Required separating speeds of joints, which correct overlaps, may add energy.
bool IslandSolver::limit_energy(ContactRows& rows, std::span<const int> points, const Velocities& before, Velocities& velocity) {
  double w = 0, q = 0, wanted = 0, size = 0;
  for (const int i : points) {
    const ContactPoint& p = rows.points[at(i)];
    const Vector3d first = rows.velocity(p, before), last = rows.velocity(p, velocity);
    w += p.impulse.dot(first);
    q += p.impulse.dot(last - first);
    if (p.couplings > 0) wanted += p.impulse.x() * std::max(0.0, p.min_speed_m_s);
    size += std::abs(p.impulse.dot(first)) + std::abs(p.impulse.dot(last));
  }
  if (w + q / 2 <= wanted + kEnergyRounding * size) return false;
  const double share = q > 0 ? std::clamp(-2 * w / q, 0.0, 1.0) : 0;
  for (const int i : points) {
    ContactPoint& p = rows.points[at(i)];
    const Vector3d by = (share - 1) * p.impulse;
    p.impulse *= share;
    rows.apply(p, by, velocity);
  }
  return true;
}

IslandSolver::Result IslandSolver::refine(ContactRows& rows, std::span<const JointRow> joints, int movers, double settled,
                                          const Velocities& before, Velocities& velocity) {
  Result out;
  find_islands(rows, joints, movers);
  int work = 0;
  for (const Island& island : islands_) {
    const auto points = points_of(island);
    double residual = residual_m_s(rows, points, velocity);
    if (residual > settled && !island.has_joints && island.count <= kMaxPoints && work + island.count * island.count <= kMaxWork) {
      work += island.count * island.count;
      if (solve(rows, points, settled, velocity)) residual = residual_m_s(rows, points, velocity);
    }
    if (residual > settled) ++out.unconverged;
    if (residual > settled && !island.has_joints && limit_energy(rows, points, before, velocity)) ++out.limited;
    out.residual_m_s = std::max(out.residual_m_s, residual);
  }
  return out;
}

}  // namespace tactus::sim::impulse
