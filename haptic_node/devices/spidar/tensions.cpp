#include "haptic_node/devices/spidar/tensions.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>

namespace tactus::haptic {
namespace {

using Vector2 = Eigen::Vector2d;
// Ratio of the smallest to the largest pivot below which a pose counts as singular (design: a force of a
// thousandth of the tensions would need a thousand times larger tensions).
constexpr double kSingular = 1e-3;
// Rounding of the tensions, N: far below the resolution of a motor.
constexpr double kSlack_N = 1e-9;

// A reduced force is lowered by up to this additional share, so that the tensions have room and do not jump
// between corners of the allowed region (design: one fiftieth, below the discrimination threshold of a hand).
constexpr double kMargin = 0.02;

// The tensions that give share * w are particular * share + null * z: a plane (with four strings a line). The
// limits of every string cut it to a convex polygon.
struct Solutions {
  PerString particular;
  Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kMaxStrings, 2>
      null;  // orthonormal columns; with four strings one is 0
  double min_N, max_N;
};

// At most four corners and one more per cut.
struct Polygon {
  std::array<Vector2, 4 + 2 * kMaxStrings> corner;
  int size = 0;
};

// Keeps the part where normal . z <= bound (Sutherland and Hodgman 1974).
void cut(Polygon& p, const Vector2& normal, double bound) {
  Polygon out;
  for (int i = 0; i < p.size; ++i) {
    const Vector2 &a = p.corner[static_cast<std::size_t>(i)],
                  &b = p.corner[static_cast<std::size_t>((i + 1) % p.size)];
    const double da = normal.dot(a) - bound, db = normal.dot(b) - bound;
    if (da <= 0) out.corner[static_cast<std::size_t>(out.size++)] = a;
    if ((da < 0 && db > 0) || (da > 0 && db < 0))
      out.corner[static_cast<std::size_t>(out.size++)] = a + da / (da - db) * (b - a);
  }
  p = out;
}

Polygon allowed(const Solutions& s, double share) {
  // z| = |tensions - their part in the row space|, so no z outside this square is within the limits.
  const double reach = 2 * s.max_N * kMaxStrings + share * s.particular.norm();
  Polygon p;
  p.corner[0] = {-reach, -reach}, p.corner[1] = {reach, -reach}, p.corner[2] = {reach, reach},
  p.corner[3] = {-reach, reach};
  p.size = 4;
  for (int i = 0; i < s.particular.size() && p.size > 0; ++i) {
    const Vector2 n = s.null.row(i).transpose();
    const double t = share * s.particular(i);
    if (n.norm() < 1e-12) {
      if (t < s.min_N - kSlack_N || t > s.max_N + kSlack_N) p.size = 0;
      continue;
    }
    cut(p, n, s.max_N + kSlack_N - t);
    cut(p, -n, t - s.min_N + kSlack_N);
  }
  return p;
}

Vector2 closest(const Polygon& p, const Vector2& goal) {
  Vector2 best = p.corner[0];
  bool inside = p.size > 2;
  for (int i = 0; i < p.size; ++i) {
    const Vector2& a = p.corner[static_cast<std::size_t>(i)];
    const Vector2 edge = p.corner[static_cast<std::size_t>((i + 1) % p.size)] - a, to = goal - a;
    inside = inside && edge.x() * to.y() - edge.y() * to.x() >= 0;
    const double square = edge.squaredNorm();
    const Vector2 on = a + (square > 0 ? std::clamp(to.dot(edge) / square, 0.0, 1.0) : 0.0) * edge;
    if ((on - goal).squaredNorm() < (best - goal).squaredNorm()) best = on;
  }
  return inside ? goal : best;
}

// False: the structure matrix does not have full rank.
template <int Rows, int Strings>
bool decompose(const StructureMatrix& w, const Eigen::Matrix<double, Rows, 1>& wanted, Solutions& s) {
  const Eigen::Matrix<double, Strings, Rows> transposed = w.transpose();
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, Strings, Rows>> qr(transposed);
  const auto r = qr.matrixR().template topLeftCorner<Rows, Rows>();
  if (std::abs(r(Rows - 1, Rows - 1)) < kSingular * std::abs(r(0, 0))) return false;
  const Eigen::Matrix<double, Strings, Strings> q = qr.householderQ();
  const Eigen::Matrix<double, Rows, 1> permuted = qr.colsPermutation().transpose() * wanted;
  const Eigen::Matrix<double, Rows, 1> y = r.template triangularView<Eigen::Upper>().transpose().solve(permuted);
  s.particular = q.template leftCols<Rows>() * y;
  s.null.setZero(Strings, 2);
  s.null.template leftCols<Strings - Rows>() = q.template rightCols<Strings - Rows>();
  return true;
}

// Share of the wanted wrench that the strings give: 1, or the largest share with allowed tensions, less some room;
// below 0: not even a share of 0 is possible.
double given_share(const Solutions& s) {
  if (allowed(s, 1).size > 0) return 1;
  if (allowed(s, 0).size == 0) return -1;
  double low = 0, high = 1;
  for (int i = 0; i < 40; ++i) {  // bisects 1 to 1e-12 of the force
    const double middle = (low + high) / 2;
    (allowed(s, middle).size > 0 ? low : high) = middle;
  }
  return low * (1 - std::min(kMargin, 10 * kMargin * (1 - low)));
}

}  // namespace

Tensions solve_tensions(const StringFrame& frame, const GripPose& pose, const Wrench& wanted) {
  const StructureMatrix w = structure_matrix(frame, pose);
  const double lever_m = frame.lever_m();
  Solutions s;
  s.min_N = frame.min_tension_N;
  s.max_N = frame.max_tension_N;
  Eigen::Matrix<double, 6, 1> goal;
  goal << wanted.force_N, wanted.torque_N_m / lever_m;
  const bool regular = frame.has_torque() ? decompose<6, 8>(w, goal, s) : decompose<3, 4>(w, goal.head<3>(), s);

  Tensions out;
  out.tensions_N.setConstant(frame.size(), s.min_N);
  const double share = regular ? given_share(s) : -1;
  if (share >= 0) {
    out.held = true;
    out.share = share;
    // Closest to the minimum tension of every string; the particular solution has no part in the null space.
    const Vector2 z = closest(allowed(s, share), s.null.transpose() * out.tensions_N);
    out.tensions_N = (share * s.particular + s.null * z).cwiseMax(s.min_N).cwiseMin(s.max_N);
  }
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> realised = w * out.tensions_N;
  out.realised.force_N = realised.head<3>();
  if (frame.has_torque()) out.realised.torque_N_m = lever_m * realised.tail<3>();
  out.force_error_N = (out.realised.force_N - wanted.force_N).norm();
  out.torque_error_N_m = (out.realised.torque_N_m - wanted.torque_N_m).norm();
  return out;
}

}  // namespace tactus::haptic
