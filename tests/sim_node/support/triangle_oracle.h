// Distance of two triangles by another method than the library's. Every pair of features (corner, edge or face of
// each) is solved as a separate least-squares problem in long double. The answer is the best solution that lies on
// both features. Slow, and also correct for degenerate and intersecting triangles.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::sim::test {

using Exact = Eigen::Matrix<long double, 3, 1>;
using Corners = std::array<Eigen::Vector3d, 3>;

namespace detail {

// A feature: its first corner and the vectors to the others.
struct Feature {
  Exact at;
  Exact direction[2];
  int directions = 0;
};

inline Feature feature(const Corners& t, unsigned corners) {
  Feature f;
  bool first = true;
  for (unsigned i = 0; i < 3; ++i) {
    if (!(corners & 1u << i)) continue;
    const Exact v = t[i].cast<long double>();
    if (first)
      f.at = v;
    else
      f.direction[f.directions++] = v - f.at;
    first = false;
  }
  return f;
}

// Solves the normal equations by elimination with full pivoting; false when there is no unique solution.
inline bool solve(int n, long double m[4][5]) {
  int column[4] = {0, 1, 2, 3};
  long double largest = 0;
  for (int k = 0; k < n; ++k) {
    int pi = k, pj = k;
    for (int i = k; i < n; ++i)
      for (int j = k; j < n; ++j)
        if (std::abs(m[i][j]) > std::abs(m[pi][pj])) pi = i, pj = j;
    if (k == 0) largest = std::abs(m[pi][pj]);
    if (!(std::abs(m[pi][pj]) > 1e-17L * largest)) return false;
    for (int j = 0; j <= 4; ++j) std::swap(m[k][j], m[pi][j]);
    for (int i = 0; i < n; ++i) std::swap(m[i][k], m[i][pj]);
    std::swap(column[k], column[pj]);
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      const long double factor = m[i][k] / m[k][k];
      for (int j = k; j <= 4; ++j)
        if (j < n || j == 4) m[i][j] -= factor * m[k][j];
    }
  }
  long double x[4];
  for (int k = 0; k < n; ++k) x[column[k]] = m[k][4] / m[k][k];
  for (int k = 0; k < n; ++k) m[k][4] = x[k];
  return true;
}

// Clamps a solution that is off a feature by rounding; false when it is further off.
inline bool settle(int directions, long double* x) {
  long double sum = 0;
  for (int i = 0; i < directions; ++i) {
    if (x[i] < -1e-9L) return false;
    x[i] = std::max(x[i], 0.0L);
    sum += x[i];
  }
  if (sum > 1 + 1e-9L) return false;
  if (sum > 1)
    for (int i = 0; i < directions; ++i) x[i] /= sum;
  return true;
}

}  // namespace detail

inline double exact_distance(const Corners& a, const Corners& b) {
  long double best = 1e300L;
  for (unsigned ca = 1; ca < 8; ++ca)
    for (unsigned cb = 1; cb < 8; ++cb) {
      const detail::Feature fa = detail::feature(a, ca), fb = detail::feature(b, cb);
      const int n = fa.directions + fb.directions;
      Exact direction[4];
      for (int i = 0; i < fa.directions; ++i) direction[i] = fa.direction[i];
      for (int i = 0; i < fb.directions; ++i) direction[fa.directions + i] = -fb.direction[i];
      const Exact apart = fa.at - fb.at;
      long double m[4][5] = {};
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) m[i][j] = direction[i].dot(direction[j]);
        m[i][4] = -direction[i].dot(apart);
      }
      if (n > 0 && !detail::solve(n, m)) continue;  // a smaller feature is equally near
      long double x[4] = {};
      for (int i = 0; i < n; ++i) x[i] = m[i][4];
      if (!detail::settle(fa.directions, x) || !detail::settle(fb.directions, x + fa.directions)) continue;
      Exact d = apart;
      for (int i = 0; i < n; ++i) d += x[i] * direction[i];
      best = std::min(best, d.dot(d));
    }
  return static_cast<double>(std::sqrt(best));
}

inline double exact_distance(const Eigen::Vector3d& p, const Corners& t) { return exact_distance({p, p, p}, t); }

}  // namespace tactus::sim::test
