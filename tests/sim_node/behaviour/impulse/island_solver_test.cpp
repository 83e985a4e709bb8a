#include "sim_node/behaviour/impulse/island_solver.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <optional>

#include "tests/sim_node/support/meshes.h"

using namespace tactus::sim;
using namespace tactus::sim::impulse;

namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using tactus::sim::test::direction;
using tactus::sim::test::Random;
using tactus::sim::test::uniform;

// One to three free bodies with one to three contacts between them and with the ground, in one island.
struct SmallIsland {
  ContactRows rows;
  Velocities before;
  int bodies = 0;

  SmallIsland(Random& random, bool with_friction) {
    bodies = 1 + static_cast<int>(uniform(random, 0, 2.999));
    before.twists.resize(static_cast<std::size_t>(bodies) + 1);
    rows.inertias.resize(before.twists.size());
    for (std::size_t i = 1; i < before.twists.size(); ++i) {
      before.twists[i] = {uniform(random, 0, 1) * direction(random), uniform(random, 0, 10) * direction(random)};
      const double mass = std::exp(uniform(random, -3, 3));
      rows.inertias[i].inverse_mass_1_kg = 1 / mass;
      // Radii of gyration of 2 to 10 cm, which no triangle inequality excludes.
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(uniform(random, 0, 3), direction(random)).toRotationMatrix();
      const Vector3d moments = mass * Vector3d(uniform(random, 0.003, 0.005), uniform(random, 0.003, 0.005), uniform(random, 0.003, 0.005));
      rows.inertias[i].inverse_inertia = turn * moments.cwiseInverse().asDiagonal() * turn.transpose();
    }
    for (int i = 0, n = bodies == 1 ? 1 + static_cast<int>(uniform(random, 0, 2.999)) : bodies; i < n; ++i)
      add(random, bodies == 1 ? 0 : i % bodies, bodies == 1 ? 1 : i % bodies + 1, with_friction ? uniform(random, 0.1, 1) : 0);
  }
  void add(Random& random, int a, int b, double friction) {
    ContactPoint p;
    p.a = p.mover_a = a, p.b = p.mover_b = b;
    const Vector3d normal = direction(random), across = normal.unitOrthogonal();
    p.axes.row(0) = normal, p.axes.row(1) = across, p.axes.row(2) = normal.cross(across);
    p.arm_a = 0.1 * direction(random), p.arm_b = 0.1 * direction(random);
    p.friction = friction;
    rows.compute_mobility(p);
    rows.groups.push_back({.first = static_cast<int>(rows.points.size()), .count = 1, .manifold = 0, .mover_a = a - 1, .mover_b = b - 1});
    rows.points.push_back(p);
  }
  std::size_t contacts() const { return rows.points.size(); }

  // Velocity of each contact, as a linear map of the stacked twists.
  MatrixXd jacobian() const {
    MatrixXd j = MatrixXd::Zero(3 * static_cast<Eigen::Index>(contacts()), 6 * bodies);
    for (std::size_t i = 0; i < contacts(); ++i) {
      const ContactPoint& p = rows.points[i];
      const auto add_side = [&](int body, const Vector3d& arm, double sign) {
        if (body == 0) return;
        for (int r = 0; r < 3; ++r) {
          const Vector3d axis = p.axes.row(r);
          j.block<1, 3>(3 * static_cast<Eigen::Index>(i) + r, 6 * (body - 1)) = sign * axis.transpose();
          j.block<1, 3>(3 * static_cast<Eigen::Index>(i) + r, 6 * (body - 1) + 3) = sign * arm.cross(axis).transpose();
        }
      };
      add_side(p.a, p.arm_a, -1);
      add_side(p.b, p.arm_b, 1);
    }
    return j;
  }
  MatrixXd inverse_masses() const {
    MatrixXd m = MatrixXd::Zero(6 * bodies, 6 * bodies);
    for (int i = 0; i < bodies; ++i) {
      m.block<3, 3>(6 * i, 6 * i) = rows.inertias[static_cast<std::size_t>(i) + 1].inverse_mass_1_kg * Eigen::Matrix3d::Identity();
      m.block<3, 3>(6 * i + 3, 6 * i + 3) = rows.inertias[static_cast<std::size_t>(i) + 1].inverse_inertia;
    }
    return m;
  }
  VectorXd stacked(const Velocities& v) const {
    VectorXd out(6 * bodies);
    for (int i = 0; i < bodies; ++i) out.segment<3>(6 * i) = v.twists[static_cast<std::size_t>(i) + 1].linear_m_s, out.segment<3>(6 * i + 3) = v.twists[static_cast<std::size_t>(i) + 1].angular_rad_s;
    return out;
  }
  VectorXd impulses() const {
    VectorXd out(3 * static_cast<Eigen::Index>(contacts()));
    for (std::size_t i = 0; i < contacts(); ++i) out.segment<3>(3 * static_cast<Eigen::Index>(i)) = rows.points[i].impulse;
    return out;
  }
};

// Velocities after contact without friction, by trying every set of contacts that press: those of the set keep no normal speed,
// and no contact pulls or approaches. The velocities of all sets that satisfy this are equal.
std::optional<VectorXd> enumerated(const SmallIsland& island) {
  const MatrixXd all = island.jacobian(), inverse = island.inverse_masses();
  const auto n = static_cast<Eigen::Index>(island.contacts());
  MatrixXd normals(n, all.cols());
  for (Eigen::Index i = 0; i < n; ++i) normals.row(i) = all.row(3 * i);
  const VectorXd before = island.stacked(island.before);
  for (int set = 0; set < 1 << n; ++set) {
    MatrixXd pressing(0, all.cols());
    for (Eigen::Index i = 0; i < n; ++i)
      if (set >> i & 1) {
        pressing.conservativeResize(pressing.rows() + 1, Eigen::NoChange);
        pressing.row(pressing.rows() - 1) = normals.row(i);
      }
    const MatrixXd mobility = pressing * inverse * pressing.transpose();
    const Eigen::FullPivLU<MatrixXd> solver(mobility);
    if (pressing.rows() > 0 && !solver.isInvertible()) continue;
    const VectorXd impulse = pressing.rows() > 0 ? VectorXd(solver.solve(-pressing * before)) : VectorXd(0);
    const VectorXd after = before + inverse * pressing.transpose() * impulse;
    if ((impulse.array() >= 0).all() && ((normals * after).array() >= -1e-12).all()) return after;
  }
  return std::nullopt;
}

// Largest violation of Coulomb's law, m/s: approach, pull, force without touch, force outside the cone, sliding that friction
// does not oppose.
double coulomb_violation(const SmallIsland& island, const VectorXd& after) {
  const VectorXd speed = island.jacobian() * after, impulse = island.impulses();
  double worst = 0;
  for (std::size_t i = 0; i < island.contacts(); ++i) {
    const ContactPoint& p = island.rows.points[i];
    const auto first = 3 * static_cast<Eigen::Index>(i);
    const double per_impulse = p.mobility(0, 0), pressing = impulse[first];
    const Eigen::Vector2d sliding = speed.segment<2>(first + 1), friction = impulse.segment<2>(first + 1);
    worst = std::max({worst, -speed[first], -per_impulse * pressing, per_impulse * (friction.norm() - p.friction * pressing)});
    worst = std::max(worst, std::min(std::abs(speed[first]), per_impulse * std::abs(pressing)));
    // While it slides: friction on the cone, against the sliding.
    const Eigen::Vector2d expected = -p.friction * pressing * sliding / std::max(1e-300, sliding.norm());
    worst = std::max(worst, std::min(sliding.norm(), per_impulse * (friction - expected).norm()));
  }
  return worst;
}

double kinetic_J(const SmallIsland& island, const VectorXd& v) { return 0.5 * v.dot(island.inverse_masses().inverse() * v); }

}  // namespace

TEST_CASE("Small islands without friction move as the enumeration of their contacts says") {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    SmallIsland island(random, false);
    const auto truth = enumerated(island);
    REQUIRE(truth);
    Velocities after = island.before;
    IslandSolver().refine(island.rows, {}, island.bodies, 1e-9, island.before, after);
    INFO("island " << i << " of " << island.bodies << " bodies and " << island.contacts() << " contacts");
    // Spins of 10 rad/s at arms of 0.1 m: speeds of 1 m/s.
    CHECK((island.stacked(after) - *truth).norm() < 1e-6 * (1 + truth->norm()));
  }
}

TEST_CASE("Small islands with friction obey Coulomb's law, or are reported and gain no energy") {
  Random random(2);
  int reported = 0;
  constexpr int kIslands = 2000;
  for (int i = 0; i < kIslands; ++i) {
    SmallIsland island(random, true);
    Velocities velocity = island.before;
    const auto result = IslandSolver().refine(island.rows, {}, island.bodies, 1e-9, island.before, velocity);
    const VectorXd after = island.stacked(velocity), before = island.stacked(island.before);
    INFO("island " << i << " of " << island.bodies << " bodies and " << island.contacts() << " contacts");
    // Impulses act on both sides.
    CHECK((before + island.inverse_masses() * island.jacobian().transpose() * island.impulses() - after).norm() < 1e-9 * (1 + after.norm()));
    CHECK(kinetic_J(island, after) <= kinetic_J(island, before) * (1 + 1e-9));
    if (result.unconverged == 0)
      CHECK(coulomb_violation(island, after) < 1e-6);
    else
      ++reported;
  }
  INFO(reported << " of " << kIslands << " did not converge");
  CHECK(reported <= kIslands / 100);
}
