#include <catch2/catch.hpp>

#include "tests/sim_node/support/articulated_trees.h"

using namespace tactus::sim;
using namespace tactus::sim::articulated;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

std::size_t index_of(int i) { return static_cast<std::size_t>(i); }

// Inverse dynamics in the classical form (Newton and Euler for each link, in three dimensions), independent of the
// algorithm under test: the joint forces that these accelerations require, and for a free base the force and moment
// about its centre that would hold it.
struct NewtonEuler {
  ArticulatedSystem& s;
  std::vector<double> needed;
  Vector3d base_force = Vector3d::Zero(), base_moment = Vector3d::Zero();

  explicit NewtonEuler(ArticulatedSystem& system) : s(system), needed(system.tree().dofs.size()) {
    const auto& links = s.tree().links;
    const std::vector<double> ddq(s.accelerations().begin(), s.accelerations().end());
    const auto& dq = s.state().rates;
    struct Body {
      Vector3d anchor, centre, spin, turning, speed_up, force, moment;
      Vector3d axes[3];
    };
    std::vector<Body> b(links.size());
    const Dynamics& placed = s.dynamics();
    for (std::size_t i = 0; i < links.size(); ++i) {
      const LinkDef& d = links[i].def;
      const bool root = d.parent < 0;
      const Eigen::Matrix3d turn = placed.rotation(static_cast<int>(i));
      const Eigen::Matrix3d before = root ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : placed.rotation(d.parent);
      const Vector3d spin = root ? Vector3d(0, 0, 0) : b[index_of(d.parent)].spin;
      const Vector3d turning = root ? Vector3d(0, 0, 0) : b[index_of(d.parent)].turning;
      Body& me = b[i];
      me.centre = placed.centre_m(static_cast<int>(i));
      const double *v = dq.data() + links[i].first_dof, *a = ddq.data() + links[i].first_dof;
      if (d.is_free) {
        me.spin = {v[0], v[1], v[2]};
        me.turning = {a[0], a[1], a[2]};
        me.speed_up = {a[3], a[4], a[5]};
        me.anchor = me.centre;
      } else {
        const Vector3d arm =
            before * (root ? Vector3d(0, 0, 0) : Vector3d(d.anchor_m - links[index_of(d.parent)].def.centre_m));
        me.anchor = root ? d.anchor_m : Vector3d(b[index_of(d.parent)].centre + arm);
        Vector3d sliding = Vector3d::Zero(), slide_up = Vector3d::Zero();
        me.spin = spin;
        me.turning = turning;
        for (int k = 0; k < links[i].dofs; ++k) {
          Vector3d axis =
              d.joint == JointKind::kBall ? Vector3d(turn.col(k)) : Vector3d(before * d.axes[k].axis.normalized());
          if (d.joint == JointKind::kUniversal && k == 1) axis = turn * d.axes[1].axis.normalized();
          me.axes[k] = axis;
          if (d.joint == JointKind::kPrismatic) {
            const double q = s.state().positions[index_of(links[i].first_coordinate)];
            me.anchor += q * axis;
            sliding = v[0] * axis;
            slide_up = a[0] * axis;
            continue;
          }
          const Vector3d carried_by = d.joint == JointKind::kUniversal ? me.spin : spin;
          me.turning += a[k] * axis + carried_by.cross(v[k] * axis);
          me.spin += v[k] * axis;
        }
        const Vector3d r = root ? Vector3d(me.anchor - d.anchor_m) : Vector3d(me.anchor - b[index_of(d.parent)].centre);
        const Vector3d base = root ? Vector3d(0, 0, 0) : b[index_of(d.parent)].speed_up;
        const Vector3d at_anchor =
            base + turning.cross(r) + spin.cross(spin.cross(r)) + 2 * spin.cross(sliding) + slide_up;
        const Vector3d lever = me.centre - me.anchor;
        me.speed_up = at_anchor + me.turning.cross(lever) + me.spin.cross(me.spin.cross(lever));
      }
      const Eigen::Matrix3d inertia = turn * d.inertia_kg_m2 * turn.transpose();
      me.force = d.mass_kg * (me.speed_up - d.gravity_m_s2);
      me.moment =
          inertia * me.turning + me.spin.cross(inertia * me.spin) + (me.centre - me.anchor).cross(me.force);
    }
    for (std::size_t i = links.size(); i-- > 0;) {
      for (int k = 0; k < links[i].dofs && !links[i].def.is_free; ++k)
        needed[index_of(links[i].first_dof + k)] =
            b[i].axes[k].dot(links[i].def.joint == JointKind::kPrismatic ? b[i].force : b[i].moment);
      const int parent = links[i].def.parent;
      if (parent >= 0) {
        b[index_of(parent)].force += b[i].force;
        b[index_of(parent)].moment += b[i].moment + (b[i].anchor - b[index_of(parent)].anchor).cross(b[i].force);
      } else if (links[i].def.is_free) {
        base_force = b[i].force;
        base_moment = b[i].moment;
      }
    }
  }
};

Eigen::VectorXd joined(ArticulatedSystem& s, int link, const Vector3d& p, const Vector3d& impulse) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(s.tree().dofs.size()));
  s.dynamics().impulse_to_rates(link, p, impulse, {out.data(), s.tree().dofs.size()});
  return out;
}

}  // namespace

TEST_CASE("Newton-Euler inverse dynamics returns the applied torques for every joint type") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int n = 0; n < 200; ++n) {
    ArticulatedSystem s(random_tree(1 + n % 9, n % 3 == 0, random));
    randomize_state(s, random);
    std::vector<double> torque(s.tree().dofs.size());
    for (std::size_t j = 0; j < torque.size(); ++j)
      if (!s.tree().links[index_of(s.tree().dofs[j].link)].def.is_free)
        set_torque(s, static_cast<int>(j), torque[j] = u(random));
    const NewtonEuler oracle(s);
    double largest = 1;
    for (const double a : s.accelerations()) largest = std::max(largest, std::abs(a));
    INFO("tree " << n << " fastest " << largest);
    // Tolerance of sums of about 50 terms of the size of mass, length and acceleration (all below 1 here).
    for (std::size_t j = 0; j < torque.size(); ++j)
      CHECK(oracle.needed[j] == Approx(torque[j]).margin(1e-12 * largest));
    CHECK(oracle.base_force.norm() < 1e-12 * largest);
    CHECK(oracle.base_moment.norm() < 1e-12 * largest);
  }
}

TEST_CASE("The power of forces and moments on links equals the rate of energy") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int n = 0; n < 30; ++n) {
    ArticulatedSystem s(random_tree(5, n % 2 == 0, random));
    randomize_state(s, random, 1);
    const Vector3d force(u(random), u(random), u(random)), moment(u(random), u(random), u(random));
    const Vector3d point = s.dynamics().centre_m(4) + Vector3d(0.1, 0.2, -0.1);
    const double power = force.dot(s.dynamics().velocity_at(4, point)) + moment.dot(s.dynamics().spin_rad_s(4));
    const double before = energy_J(s), h = 1e-6;
    s.add_force(4, force, point);
    s.add_moment(4, moment);
    s.step(h);
    // One-sided difference: the error is h times the second derivative, about 1e3 W/s here; rounding is 1e-15 J / h =
    // 1e-9 W.
    CHECK((energy_J(s) - before) / h == Approx(power).margin(5e-3));
  }
}

TEST_CASE("The velocity of a point is its Jacobian times the joint rates") {
  std::mt19937 random(3);
  for (int n = 0; n < 30; ++n) {
    ArticulatedSystem s(random_tree(6, n % 2 == 0, random));
    randomize_state(s, random);
    const auto state = s.state();
    const std::size_t dofs = state.rates.size();
    const Vector3d local(0.1, -0.2, 0.3);
    const auto place = [&] { return Vector3d(s.dynamics().centre_m(5) + s.dynamics().rotation(5) * local); };
    const Vector3d here = place();
    std::vector<double> rows(3 * dofs);
    s.dynamics().jacobian(5, here, rows);
    Vector3d sum = Vector3d::Zero();
    for (std::size_t j = 0; j < dofs; ++j)
      for (int k = 0; k < 3; ++k) sum[k] += rows[index_of(k) * dofs + j] * state.rates[j];
    CHECK((sum - s.dynamics().velocity_at(5, here)).norm() < 1e-12 * (1 + sum.norm()));
    // And with the poses. Central difference: the error is h^2 v'' / 6 with v'' below 1e4 m/s^3.
    const double h = 1e-5;
    std::vector<double> by(dofs);
    for (std::size_t j = 0; j < dofs; ++j) by[j] = h * state.rates[j];
    s.displace(by);
    const Vector3d after = place();
    for (double& d : by) d = -d;
    s.set_state(state);
    s.displace(by);
    CHECK(((after - place()) / (2 * h) - sum).norm() < 1e-6);
  }
}

TEST_CASE("The response of one point to an impulse at another is symmetric and matches the joint rates") {
  std::mt19937 random(4);
  for (int n = 0; n < 60; ++n) {
    ArticulatedSystem s(random_tree(2 + n % 7, n % 3 == 0, random));
    randomize_state(s, random);
    const int links = static_cast<int>(s.tree().links.size());
    const int a = n % links, b = (3 * n + 1) % links;
    const Vector3d pa = s.dynamics().centre_m(a) + Vector3d(0.1, 0, 0.2),
                   pb = s.dynamics().centre_m(b) - Vector3d(0, 0.3, 0);
    const Eigen::Matrix3d there = s.dynamics().response(a, pa, b, pb), back = s.dynamics().response(b, pb, a, pa);
    const double scale = 1e-11 * (1 + there.norm());
    CHECK((there - back.transpose()).norm() < scale);
    // The same with the joint rates, J M^-1 J^T.
    std::vector<double> rows(3 * s.tree().dofs.size());
    s.dynamics().jacobian(a, pa, rows);
    const Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>> jacobian(
        rows.data(), 3, static_cast<Eigen::Index>(s.tree().dofs.size()));
    for (int k = 0; k < 3; ++k)
      CHECK((jacobian * joined(s, b, pb, Vector3d::Unit(k)) - there.col(k)).norm() < scale);
    // Energy of an impulse: the body gains half the impulse times its change of velocity.
    auto still = s.state();
    std::fill(still.rates.begin(), still.rates.end(), 0.0);
    s.set_state(still);
    const Vector3d impulse(0.3, -0.2, 0.5);
    const Eigen::VectorXd rates = joined(s, b, pb, impulse);
    const double expected = 0.5 * impulse.dot(s.dynamics().response(b, pb, b, pb) * impulse);
    s.add_rates({rates.data(), s.tree().dofs.size()});
    CHECK(kinetic_energy_J(s) == Approx(expected).margin(1e-11 * (1 + expected)));
  }
}

TEST_CASE("The response of one joint to an impulse along another is symmetric") {
  std::mt19937 random(5);
  ArticulatedSystem s(random_tree(7, true, random));
  randomize_state(s, random);
  const std::size_t n = s.tree().dofs.size();
  Eigen::MatrixXd inverse(n, n);
  for (std::size_t j = 0; j < n; ++j) s.dynamics().dof_impulse_to_rates(static_cast<int>(j), {inverse.data() + j * n, n});
  CHECK((inverse - inverse.transpose()).norm() < 1e-11 * inverse.norm());
  CHECK(inverse.ldlt().isPositive());
}

TEST_CASE("An impulse at the middle of a free rod leaves its centre of percussion at rest") {
  // A rod of length l struck at 2/3 l rotates about its end without a load on it. A hinge there gets no force, so the
  // free rod and the hinged one move equally.
  std::vector<LinkDef> hinged = {rod_link(-1, JointKind::kBall, {0, 0, 0})};
  const double m = hinged[0].mass_kg, inertia = hinged[0].inertia_kg_m2(2, 2), half = 0.05;
  std::vector<LinkDef> loose = hinged;
  loose[0].is_free = true;
  ArticulatedSystem a(hinged), b(loose);
  const Vector3d struck(half + inertia / (m * half), 0, 0), blow(0, 0.01, 0);
  const Eigen::VectorXd ra = joined(a, 0, struck, blow), rb = joined(b, 0, struck, blow);
  CHECK(ra[2] == Approx(rb[2]).epsilon(1e-12));
  CHECK(rb[4] - rb[2] * half == Approx(0).margin(1e-12));
  CHECK(ra[2] == Approx(blow.y() * struck.x() / (inertia + m * half * half)).epsilon(1e-12));
}

TEST_CASE("A tree without valid dynamics is rejected with the name of its link") {
  std::vector<LinkDef> links = horizontal_chain(2);
  links[1].mass_kg = 0;
  CHECK_THROWS_WITH(ArticulatedSystem(links), Catch::Contains("link 1"));
  links = horizontal_chain(2);
  links[1].parent = -1;
  CHECK_THROWS_WITH(ArticulatedSystem(links), Catch::Contains("root"));
  links = horizontal_chain(2);
  links[0].parent = 1;
  CHECK_THROWS(ArticulatedSystem(links));
}
