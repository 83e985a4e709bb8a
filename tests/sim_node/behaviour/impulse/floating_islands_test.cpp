#include "sim_node/behaviour/impulse/floating_islands.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tactus::sim::impulse;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

struct Bodies {
  std::mt19937 random{5};
  std::vector<FloatingIslands::Body> all{{}};  // number 0: none
  std::vector<Twist> twists{{}};
  ContactRows rows;
  std::vector<double> pushed;

  Vector3d draw() {
    std::uniform_real_distribution<double> u(-1, 1);
    return {u(random), u(random), u(random)};
  }
  void add() {
    FloatingIslands::Body b;
    b.mass_kg = 0.1 + std::abs(draw().x());
    b.inertia_kg_m2 = 0.01 * b.mass_kg * (Matrix3d::Identity() + 0.3 * Matrix3d(draw().normalized().asDiagonal()));
    b.centre_m = draw();
    b.lost_kg_m2_s = 1e-5 * draw();
    all.push_back(b);
    twists.push_back({draw(), draw()});
  }
  void touch(int a, int b, double push, double gap = 0) {
    ContactPoint& p = rows.points.emplace_back();
    p.a = a, p.b = b;
    p.gap_m = gap;
    pushed.push_back(push);
  }
  void correct() {
    rows.inertias.resize(all.size());
    FloatingIslands islands;
    islands.find(rows, pushed);
    islands.restore_spin([&](int i) {
      FloatingIslands::Body b = all[static_cast<std::size_t>(i)];
      b.velocity_m_s = &twists[static_cast<std::size_t>(i)].linear_m_s;
      b.spin_rad_s = &twists[static_cast<std::size_t>(i)].angular_rad_s;
      return b;
    });
  }
  Vector3d momentum(std::initializer_list<std::size_t> of) const {
    Vector3d sum = Vector3d::Zero();
    for (const std::size_t i : of) sum += all[i].mass_kg * twists[i].linear_m_s;
    return sum;
  }
  Vector3d angular(std::initializer_list<std::size_t> of) const {
    Vector3d sum = Vector3d::Zero();
    for (const std::size_t i : of)
      sum += all[i].mass_kg * all[i].centre_m.cross(twists[i].linear_m_s) + all[i].inertia_kg_m2 * twists[i].angular_rad_s;
    return sum;
  }
};

}  // namespace

TEST_CASE("Displaced bodies that float get back the angular momentum that they lost") {
  Bodies w;
  for (int i = 0; i < 6; ++i) w.add();
  w.touch(1, 2, 1e-6);
  w.touch(3, 2, 1e-6);
  w.touch(4, 5, 1e-6);
  w.touch(3, 4, 0);  // apart: two groups
  w.touch(0, 6, 0);
  const Bodies before = w;
  w.correct();
  const auto restored = [&](std::initializer_list<std::size_t> of) {
    Vector3d lost = Vector3d::Zero();
    for (const std::size_t i : of) lost += w.all[i].lost_kg_m2_s;
    CHECK((w.angular(of) - before.angular(of) - lost).norm() < 1e-15);
    CHECK((w.momentum(of) - before.momentum(of)).norm() < 1e-15);
  };
  restored({1, 2, 3});
  restored({4, 5});
  // Relative velocities at a common point of two bodies of a group are unchanged.
  const Vector3d place(0.3, -0.2, 0.5);
  const auto relative = [&](const Bodies& of) {
    const auto at = [&](std::size_t i) -> Vector3d { return of.twists[i].linear_m_s + of.twists[i].angular_rad_s.cross(place - of.all[i].centre_m); };
    return Vector3d(at(2) - at(1));
  };
  CHECK((relative(w) - relative(before)).norm() < 1e-15);
  CHECK(w.twists[6].linear_m_s == before.twists[6].linear_m_s);
}

TEST_CASE("Displaced bodies that touch a static body keep their velocities") {
  Bodies w;
  for (int i = 0; i < 3; ++i) w.add();
  w.touch(1, 2, 1e-6);
  w.touch(2, 3, 1e-6);
  w.touch(0, 3, 0, 5e-6);
  const Bodies before = w;
  w.correct();
  for (std::size_t i = 1; i <= 3; ++i) {
    CHECK(w.twists[i].linear_m_s == before.twists[i].linear_m_s);
    CHECK(w.twists[i].angular_rad_s == before.twists[i].angular_rad_s);
  }
}
