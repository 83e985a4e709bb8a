#include "haptic_node/devices/spidar/tensions.h"

#include <Eigen/LU>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include "tests/haptic_node/support/random_grip.h"

using namespace tactus::haptic;
using Eigen::Vector3d;
using test::random_direction;
using test::random_pose;

namespace {

Eigen::VectorXd stacked(const StringFrame& f, const Wrench& w) {
  Eigen::VectorXd out(f.has_torque() ? 6 : 3);
  out.head<3>() = w.force_N;
  if (f.has_torque()) out.tail<3>() = w.torque_N_m / f.lever_m();
  return out;
}

// Calls `visit` with every way to fix `fixed` of n strings at their minimum (0) or maximum (1) tension; -1: free.
void active_sets(int n, int fixed, std::vector<int>& set,
                 const std::function<void(const std::vector<int>&)>& visit) {
  if (static_cast<int>(set.size()) == n) {
    if (fixed == 0) visit(set);
    return;
  }
  for (int at = -1; at <= (fixed > 0 ? 1 : -1); ++at) {
    set.push_back(at);
    active_sets(n, fixed - (at >= 0 ? 1 : 0), set, visit);
    set.pop_back();
  }
}

// Independent computation of the largest share: every basic solution of the linear programme max s, W t = s w,
// least <= t <= most, 0 <= s <= 1. Empty: there is none.
std::optional<double> oracle_share(const StringFrame& f, const Eigen::MatrixXd& w, const Eigen::VectorXd& wanted) {
  const int n = f.size(), m = static_cast<int>(w.rows());
  std::optional<double> best;
  const auto attempt = [&](const std::vector<int>& set, std::optional<double> share) {
    Eigen::MatrixXd a(m, m);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(m);
    int column = 0;
    for (int i = 0; i < n; ++i) {
      if (set[i] < 0)
        a.col(column++) = w.col(i);
      else
        b -= w.col(i) * (set[i] ? f.max_tension_N : f.min_tension_N);
    }
    if (share)
      b += *share * wanted;
    else
      a.col(column) = -wanted;
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(a);
    if (!lu.isInvertible()) return;
    const Eigen::VectorXd x = lu.solve(b);
    const int strings = share ? m : m - 1;
    const double s = share ? *share : x(m - 1);
    for (int i = 0; i < strings; ++i)
      if (x(i) < f.min_tension_N - 1e-9 || x(i) > f.max_tension_N + 1e-9) return;
    if (s >= -1e-12 && s <= 1 + 1e-12) best = std::max(best.value_or(s), s);
  };
  std::vector<int> set;
  for (const double s : {0.0, 1.0}) active_sets(n, n - m, set, [&](const std::vector<int>& v) { attempt(v, s); });
  active_sets(n, n - m + 1, set, [&](const std::vector<int>& v) { attempt(v, std::nullopt); });
  return best;
}

// Some within the capability of the device, some beyond it, some far beyond.
Wrench random_wrench(const StringFrame& f, std::mt19937& random) {
  std::uniform_real_distribution<double> decade(-1, 1.7);
  Wrench w;
  w.force_N = std::pow(10, decade(random)) * random_direction(random);
  if (f.has_torque()) w.torque_N_m = f.lever_m() * std::pow(10, decade(random)) * random_direction(random);
  return w;
}

// In the workspace, or up to twice as far out.
GripPose pose_beyond_workspace(const StringFrame& f, std::mt19937& random) {
  GripPose p = random_pose(f, random);
  if (random() % 2 == 0) p.position_m *= 2;
  return p;
}

}  // namespace

TEST_CASE("Tensions stay within their limits for any pose and wrench") {
  const std::string name = GENERATE("desktop", "desktop8", "cave", "cave8");
  const StringFrame f = *known_frame(name);
  std::mt19937 random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const GripPose pose = pose_beyond_workspace(f, random);
    const Wrench wanted = random_wrench(f, random);
    const Tensions t = solve_tensions(f, pose, wanted);
    REQUIRE(t.tensions_N.size() == f.size());
    CHECK(t.tensions_N.minCoeff() >= f.min_tension_N);
    CHECK(t.tensions_N.maxCoeff() <= f.max_tension_N);
    // The reported wrench is that of the tensions.
    const Eigen::VectorXd got = structure_matrix(f, pose) * t.tensions_N;
    CHECK((got - stacked(f, t.realised)).norm() < 1e-9);
    CHECK(t.force_error_N == Approx((t.realised.force_N - wanted.force_N).norm()).margin(1e-12));
  }
}

TEST_CASE("The force is exact where tensions exist, otherwise nearly the largest in its direction") {
  const std::string name = GENERATE("desktop", "desktop8", "cave", "cave8");
  const StringFrame f = *known_frame(name);
  std::mt19937 random(2);
  int all = 0, some = 0, none = 0;
  for (int trial = 0; trial < (f.has_torque() ? 120 : 1000); ++trial) {
    const GripPose pose = pose_beyond_workspace(f, random);
    const Wrench wanted = random_wrench(f, random);
    const Eigen::MatrixXd w = structure_matrix(f, pose);
    const auto truth = oracle_share(f, w, stacked(f, wanted));
    const Tensions t = solve_tensions(f, pose, wanted);
    // A share above 0 while the grip cannot be held at rest does not count: such a force could not be released.
    const bool at_rest = oracle_share(f, w, Eigen::VectorXd::Zero(w.rows())).has_value();
    REQUIRE(t.held == (at_rest || (truth && *truth > 1 - 1e-9)));
    if (!t.held) {
      ++none;
      CHECK(t.tensions_N.maxCoeff() == f.min_tension_N);
      continue;
    }
    (*truth > 1 - 1e-9 ? all : some)++;
    CHECK(t.share <= *truth + 1e-7);
    CHECK(t.share >= 0.98 * *truth - 1e-7);
    // Tensions are rounded by 1e-9 N, of up to eight strings.
    CHECK((stacked(f, t.realised) - t.share * stacked(f, wanted)).norm() < 1e-7);
    if (*truth > 1 - 1e-9) CHECK(t.force_error_N < 1e-7);
  }
  // The sample must contain every case.
  CHECK(all > 10);
  CHECK(some > 10);
}

TEST_CASE("The tensions are the closest to the minimum that give the force") {
  const std::string name = GENERATE("desktop", "desktop8", "cave", "cave8");
  const StringFrame f = *known_frame(name);
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const GripPose pose = random_pose(f, random);
    const Wrench wanted{0.5 * random_direction(random), Vector3d::Zero()};
    const Tensions t = solve_tensions(f, pose, wanted);
    REQUIRE(t.held);
    // Every other solution differs along the null space, as far as the limits allow.
    const Eigen::MatrixXd null = Eigen::FullPivLU<Eigen::MatrixXd>(structure_matrix(f, pose)).kernel();
    const Eigen::VectorXd above = t.tensions_N - PerString::Constant(f.size(), f.min_tension_N);
    for (int k = 0; k < 24; ++k) {
      Eigen::VectorXd z(null.cols());
      z(0) = std::cos(k * M_PI / 12);
      if (z.size() > 1) z(1) = std::sin(k * M_PI / 12);
      const Eigen::VectorXd way = (null * z).normalized();
      double room = 1;
      for (int i = 0; i < f.size(); ++i) {
        if (way(i) > 1e-12) room = std::min(room, (f.max_tension_N - t.tensions_N(i)) / way(i));
        if (way(i) < -1e-12) room = std::min(room, (t.tensions_N(i) - f.min_tension_N) / -way(i));
      }
      if (room > 1e-6) CHECK((above + room * way).norm() > above.norm() - 1e-6);
    }
  }
}

TEST_CASE("Tensions are continuous in force and pose, also where limits begin to bind") {
  const std::string name = GENERATE("desktop", "desktop8", "cave", "cave8");
  const StringFrame f = *known_frame(name);
  std::mt19937 random(5);
  for (int trial = 0; trial < 5; ++trial) {
    const GripPose a = random_pose(f, random), b = random_pose(f, random);
    const Vector3d pull = random_direction(random), push = random_direction(random);
    std::array<double, 2> largest{};
    for (const int run : {0, 1}) {
      const int steps = run ? 8000 : 2000;
      std::optional<PerString> last;
      for (int i = 0; i <= steps; ++i) {
        const double s = double(i) / steps;
        const GripPose pose{(1 - s) * a.position_m + s * b.position_m, a.orientation.slerp(s, b.orientation)};
        // Across the limits: up to 25 N and back, while the direction rotates.
        const Wrench w{25 * std::sin(M_PI * s) * ((1 - s) * pull + s * push), Vector3d::Zero()};
        const Tensions t = solve_tensions(f, pose, w);
        REQUIRE(t.held);
        if (last) largest[run] = std::max(largest[run], (t.tensions_N - *last).norm());
        last = t.tensions_N;
      }
    }
    // A jump would not shrink with the step: a quarter of the step gives a quarter of the change.
    CHECK(largest[1] < 0.4 * largest[0]);
  }
}

TEST_CASE("A singular pose renders no force, and held is false") {
  StringFrame f = *known_frame("desktop");
  for (StringEnds& s : f.strings) s.anchor_m.z() = 0;  // all coplanar, with the grip in the plane
  const Tensions t = solve_tensions(f, {}, {Vector3d(0, 0, 1), Vector3d::Zero()});
  CHECK_FALSE(t.held);
  CHECK(t.tensions_N.maxCoeff() == f.min_tension_N);
  CHECK(t.force_error_N > 0.9);
}
