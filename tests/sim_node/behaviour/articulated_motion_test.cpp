#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/sim_node/support/articulated_trees.h"

using namespace tactus::sim;
using namespace tactus::sim::articulated;
using namespace tactus::sim::test;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kGravity_m_s2 = 9.81, kH = 0.001;

// A planar chain of n rods by the Lagrangian in absolute angles (from the x axis, upwards), independent of the
// algorithm under test: the centre of rod k lies at the sum of reach(k, i) e(angle_i).
struct PlanarChain {
  int n;
  double mass = 0.05, length = 0.1, inertia = 0.05 * (3 * 1e-4 + 1e-2) / 12;
  Eigen::MatrixXd coupling;  // sum over rods of mass reach_i reach_j
  VectorXd moment;           // sum over rods of mass reach_i

  explicit PlanarChain(int count) : n(count), coupling(count, count), moment(count) {
    const auto reach = [&](int k, int i) { return i < k ? length : i == k ? length / 2 : 0; };
    for (int i = 0; i < n; ++i) {
      moment[i] = 0;
      for (int k = 0; k < n; ++k) moment[i] += mass * reach(k, i);
      for (int j = 0; j < n; ++j) {
        coupling(i, j) = 0;
        for (int k = 0; k < n; ++k) coupling(i, j) += mass * reach(k, i) * reach(k, j);
      }
    }
  }
  VectorXd acceleration(const VectorXd& angle, const VectorXd& rate) const {
    Eigen::MatrixXd m(n, n);
    VectorXd force(n);
    for (int i = 0; i < n; ++i) {
      force[i] = -kGravity_m_s2 * moment[i] * std::cos(angle[i]);
      for (int j = 0; j < n; ++j) {
        m(i, j) = coupling(i, j) * std::cos(angle[i] - angle[j]) + (i == j ? inertia : 0);
        force[i] -= coupling(i, j) * std::sin(angle[i] - angle[j]) * rate[j] * rate[j];
      }
    }
    return m.ldlt().solve(force);
  }
  void step(VectorXd& q, VectorXd& v, double h) const {
    const VectorXd a1 = acceleration(q, v), v2 = v + h / 2 * a1;
    const VectorXd a2 = acceleration(q + h / 2 * v, v2), v3 = v + h / 2 * a2;
    const VectorXd a3 = acceleration(q + h / 2 * v2, v3), v4 = v + h * a3;
    const VectorXd a4 = acceleration(q + h * v3, v4);
    q += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
};

}  // namespace

TEST_CASE("A horizontal chain of eleven universal joints keeps its energy within 1 % over 5 s") {
  const double about_vertical = GENERATE(0.0, 0.5);
  const bool vertical_first = GENERATE(false, true);
  ArticulatedSystem s(vertical_first ? horizontal_chain(11, JointKind::kUniversal, {0, 0, 1}, {0, 1, 0})
                                     : horizontal_chain(11));
  auto state = s.state();
  state.rates[vertical_first ? 0 : 1] = about_vertical;
  s.set_state(state);
  // Potential energy relative to the pivot, with all rods at their distance below it: 2.968 J.
  const double scale = 0.05 * kGravity_m_s2 * 0.1 * 11 * 11 / 2, start = energy_J(s);
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    s.step(kH);
    worst = std::max(worst, std::abs(energy_J(s) - start) / scale);
  }
  INFO("about the vertical " << about_vertical << ", vertical axis first " << vertical_first << ", worst "
                             << worst);
  CHECK(worst < 0.01);
}

TEST_CASE("A planar chain follows its Lagrangian equations") {
  const int n = 4;
  ArticulatedSystem s(horizontal_chain(n, JointKind::kRevolute, {0, -1, 0}));
  const PlanarChain oracle(n);
  VectorXd q = VectorXd::Zero(n), v = VectorXd::Zero(n);
  const int fine = 20;
  double worst = 0;
  for (int i = 0; i < 600; ++i) {
    s.step(kH);
    for (int k = 0; k < fine; ++k) oracle.step(q, v, kH / fine);
    Vector3d end = Vector3d::Zero();
    for (int k = 0; k < n; ++k) end += (k + 1 < n ? 0.1 : 0.05) * Vector3d(std::cos(q[k]), 0, std::sin(q[k]));
    worst = std::max(worst, (s.dynamics().centre_m(n - 1) - end).norm());
  }
  // The error of a sub-step is at most 1e-4 of the fastest rate (30 rad/s here), in practice a hundredth of that; the
  // swing amplifies it.
  INFO("worst " << worst);
  CHECK(worst < 1e-5);
}

TEST_CASE("Small oscillations of a chain match its normal modes") {
  const int n = 5;
  std::vector<LinkDef> links;
  for (int i = 0; i < n; ++i) {
    links.push_back(rod_link(i - 1, JointKind::kUniversal, {0, 0, -0.1 * i}, {0, 0, -1}));
    links.back().axes[0].axis = {1, 0, 0};
    links.back().axes[1].axis = {0, 1, 0};
  }
  const PlanarChain chain(n);
  Eigen::MatrixXd mass = chain.coupling;
  mass.diagonal().array() += chain.inertia;
  const Eigen::MatrixXd stiffness = (kGravity_m_s2 * chain.moment).asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(stiffness, mass);
  const int axis = GENERATE(0, 1);
  for (int mode = 0; mode < n; ++mode) {
    ArticulatedSystem s(links);
    auto state = s.state();
    const double amplitude = 1e-4;
    const VectorXd shape = modes.eigenvectors().col(mode).normalized();
    for (int i = 0; i < n; ++i)
      state.positions[static_cast<std::size_t>(2 * i + axis)] =
          amplitude * (shape[i] - (i > 0 ? shape[i - 1] : 0));
    s.set_state(state);
    const double period = 2 * std::numbers::pi / std::sqrt(modes.eigenvalues()[mode]);
    const int steps = 2000;
    for (int i = 0; i < steps; ++i) s.step(period / steps);
    // After one period all coordinates return; amplitudes of 1e-4 lengthen it by 1e-9.
    for (std::size_t i = 0; i < state.positions.size(); ++i)
      CHECK(std::abs(s.state().positions[i] - state.positions[i]) < 1e-5 * amplitude);
  }
}

TEST_CASE("A rod swings with the period of the elliptic integral at any amplitude") {
  const double amplitude = GENERATE(0.1, 1.0, 2.5, 3.1);
  std::vector<LinkDef> links = {rod_link(-1, JointKind::kRevolute, {0, 0, 0}, {0, 0, -1})};
  links[0].axes[0].axis = {0, 1, 0};
  ArticulatedSystem s(links);
  auto state = s.state();
  state.positions[0] = amplitude;
  s.set_state(state);
  const double inertia = links[0].inertia_kg_m2(1, 1) + 0.05 * 0.05 * 0.05;
  const double period = 4 * std::sqrt(inertia / (0.05 * kGravity_m_s2 * 0.05)) * std::comp_ellint_1(std::sin(amplitude / 2));
  double first = -1, last = amplitude, end = 0;
  int crossings = 0;
  for (int i = 1; crossings < 11; ++i) {
    REQUIRE(i < 100000);
    const double rate = s.state().rates[0];
    s.step(kH);
    const double now = s.state().positions[0];
    if (last < 0 && now >= 0) {
      // Zero crossing of the cubic through both ends of the step, by a Newton step from the chord.
      const double mean = (rate + s.state().rates[0]) / 2;
      end = (i - 1) * kH - last / mean;
      if (first < 0) first = end;
      ++crossings;
    }
    last = now;
  }
  // The error of the chord is h^2 q'' / 8 q' < 1e-7 s in total.
  CHECK((end - first) / 10 == Approx(period).epsilon(1e-6));
}

TEST_CASE("A flying system keeps its momentum and energy") {
  std::mt19937 random(6);
  for (int n = 0; n < 10; ++n) {
    auto links = random_tree(4 + n % 3, true, random);
    for (LinkDef& l : links) l.gravity_m_s2.setZero();
    ArticulatedSystem s(links);
    randomize_state(s, random, 3);
    const auto momenta = [&] {
      Vector3d p = Vector3d::Zero(), l = Vector3d::Zero();
      for (std::size_t i = 0; i < links.size(); ++i) {
        const BodyMotion m = (s.dynamics(), s.motion(static_cast<int>(i)));
        p += links[i].mass_kg * m.velocity_m_s;
        l += m.centre_m.cross(links[i].mass_kg * m.velocity_m_s) + m.inverse_inertia.inverse() * m.spin_rad_s;
      }
      return std::pair(p, l);
    };
    const auto [p, l] = momenta();
    const double energy = energy_J(s);
    const int steps = 1000;
    for (int i = 0; i < steps; ++i) s.step(kH);
    const auto [p2, l2] = momenta();
    INFO("tree " << n << ": " << (p2 - p).norm() / p.norm() << " " << (l2 - l).norm() / l.norm());
    // Not conserved exactly: the fifth order leaves (rate h)^6 of each step's change. Rates of 3 rad/s and
    // accelerations of about 1e3 rad/s^2 give 1e-12 per step.
    CHECK((p2 - p).norm() < 1e-12 * steps * std::max(1.0, p.norm()));
    CHECK((l2 - l).norm() < 1e-12 * steps * std::max(1.0, l.norm()));
    CHECK(energy_J(s) == Approx(energy).epsilon(1e-9));
  }
}

TEST_CASE("A free asymmetric top nutates with the period of Jacobi's elliptic functions") {
  // Spinning near its middle axis: the component along it returns after 4 K(k) / rate (Landau and Lifshitz 1976,
  // section 37).
  LinkDef top;
  top.is_free = true;
  const Vector3d inertia(1e-3, 2e-3, 3e-3), spin(0.02, 3, 0.01);
  top.inertia_kg_m2 = inertia.asDiagonal();
  ArticulatedSystem s({top});
  auto state = s.state();
  for (int k = 0; k < 3; ++k) state.rates[static_cast<std::size_t>(k)] = spin[k];
  s.set_state(state);
  const double e2 = inertia.dot(spin.cwiseAbs2()), m2 = inertia.cwiseProduct(spin).squaredNorm();
  // For m^2 > 2 E I2 the first and third axes are exchanged.
  double i1 = inertia[0], i2 = inertia[1], i3 = inertia[2];
  if (m2 < e2 * i2) std::swap(i1, i3);
  const double k2 = (i2 - i1) * (e2 * i3 - m2) / ((i3 - i2) * (m2 - e2 * i1));
  const double rate = std::sqrt((i3 - i2) * (m2 - e2 * i1) / (i1 * i2 * i3));
  const double period = 4 * std::comp_ellint_1(std::sqrt(k2)) / rate;
  const int steps = static_cast<int>(period / kH);
  const Vector3d before = spin;
  for (int i = 0; i < steps; ++i) s.step(kH);
  s.step(period - steps * kH);
  const Vector3d local = s.dynamics().rotation(0).transpose() * s.dynamics().spin_rad_s(0);
  CHECK((local - before).norm() < 1e-5);
}

TEST_CASE("A saved system continues bit-identically") {
  ArticulatedSystem a(horizontal_chain(11)), b(horizontal_chain(11));
  for (int i = 0; i < 500; ++i) a.step(kH);
  b.set_state(a.state());
  a.set_state(a.state());
  for (int i = 0; i < 200; ++i) {
    a.step(kH);
    b.step(kH);
  }
  CHECK(a.state().positions == b.state().positions);
  CHECK(a.state().rates == b.state().rates);
}
