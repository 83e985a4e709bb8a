#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/sim_node/support/articulated_trees.h"
#include "tests/sim_node/support/small_worlds.h"
#include "tests/sim_node/support/toys.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

TEST_CASE("In Newton's cradle as many balls leave as arrive, touching or separated") {
  const double apart = GENERATE(0.0, 1e-4);
  const int arriving = GENERATE(1, 2, 3);
  Toys toys;
  toys.gravity_m_s2.setZero();
  const int n = 5;
  for (int i = 0; i < n; ++i) {
    const double gap = i < arriving ? -0.002 : 0;
    toys.ball(0.1, 0.02, {(0.04 + apart) * i + gap, 0, 0}, 0.5, 1);
    if (i < arriving) toys.world.free_body(i).velocity_m_s = {1, 0, 0};
  }
  for (int i = 0; i < 40; ++i) toys.step(0.001);
  double energy = 0;
  for (int i = 0; i < n; ++i) {
    const Vector3d v = toys.motion(i).velocity_m_s;
    INFO("ball " << i << " of " << arriving);
    CHECK(v.x() == Approx(i >= n - arriving ? 1 : 0).margin(1e-12));
    CHECK(v.tail<2>().norm() < 1e-12);
    energy += v.squaredNorm();
  }
  CHECK(energy == Approx(arriving).margin(1e-12));
}

TEST_CASE("A ball bounces to e^2n of its height at the predicted times, at 1 kHz and 60 Hz") {
  const double e = GENERATE(0.5, 0.8, 1.0), h = GENERATE(0.001, 1.0 / 60);
  Toys toys;
  toys.plane({0, 0, 1}, {0, 0, 0}, 0.5, e);
  const double r = 0.03, height = 1.37;
  const int ball = toys.ball(0.2, r, {0, 0, r + height}, 0.5, e);
  // Starts at rest; the leapfrog velocity belongs to half a step earlier.
  toys.world.free_body(ball).velocity_m_s.z() = h / 2 * kToyG;
  const double fall = std::sqrt(2 * height / kToyG);
  double touch = fall, worst = 0, speed = kToyG * fall;
  int bounces = 0;
  for (int i = 1; bounces < 3 || e == 1; ++i) {
    toys.step(h);
    const double t = i * h;
    while (t > touch) {
      speed *= e;
      touch += 2 * speed / kToyG;
      ++bounces;
    }
    if (bounces >= 4) break;
    const double since = t - (touch - 2 * speed / kToyG);
    const double expected = bounces == 0 ? height - kToyG * t * t / 2 : speed * since - kToyG * since * since / 2;
    worst = std::max(worst, std::abs(toys.motion(ball).centre_m.z() - r - expected));
  }
  INFO("e " << e << " h " << h << " worst " << worst);
  // Impacts inside a step have exact times; the rest is rounding.
  CHECK(worst < 1e-11);
}

TEST_CASE("A box that falls flat rebounds flat") {
  Toys toys;
  toys.plane({0, 0, 1}, {0, 0, 0}, 0.5, 0.6);
  const int box = toys.box(1, {0.1, 0.2, 0.05}, at(0, 0, 0.125), 0.5, 0.6);
  double top = 0;
  for (int i = 0; i < 260; ++i) {
    toys.step(0.001);
    if (i > 150) top = std::max(top, toys.motion(box).centre_m.z() - 0.025);
  }
  CHECK(top == Approx(0.36 * 0.1).epsilon(2e-3));  // the first half step of gravity, see above: h v / 2 of 0.1 m
  CHECK(toys.motion(box).spin_rad_s.norm() < 1e-9);
}

TEST_CASE("A collision with friction and spin keeps linear and angular momentum") {
  Toys toys;
  toys.gravity_m_s2.setZero();
  const int a = toys.ball(0.3, 0.05, {-0.2, 0, 0}, 0.4, 0.6),
            b = toys.ball(0.7, 0.08, {0.2, 0.03, 0.01}, 0.4, 0.6);
  auto &fa = toys.world.free_body(a), &fb = toys.world.free_body(b);
  fa.velocity_m_s = {1, 0, 0};
  fa.spin_rad_s = {3, 20, -7};
  fb.velocity_m_s = {-0.5, 0.1, 0};
  const auto momenta = [&] {
    Vector3d p = Vector3d::Zero(), l = Vector3d::Zero();
    for (const auto* f : {&fa, &fb}) {
      p += f->mass_kg * f->velocity_m_s;
      l += f->mass_kg * f->centre_m.cross(f->velocity_m_s) + f->inertia_kg_m2 * f->spin_rad_s;
    }
    return std::pair(p, l);
  };
  const auto [p, l] = momenta();
  for (int i = 0; i < 600; ++i) toys.step(0.001);
  CHECK(fa.velocity_m_s.x() < 0);
  CHECK((momenta().first - p).norm() < 1e-12);
  // The impulse is computed at the impact and applied at the poses of the start of the step. The error is the
  // distance between, h times the closing speed of 1.5 m/s, times the impulse of at most (1 + e) 0.21 kg 1.5 m/s.
  CHECK((momenta().second - l).norm() < 0.001 * 1.5 * 1.6 * 0.21 * 1.5);
}

TEST_CASE("A ball that meets two planes in one step rebounds from them in the order of the impacts") {
  std::mt19937 random(11);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  int slower_first = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const double turn = draw(0.6, 2.4), h = 0.001, r = 0.02;
    const Vector3d normals[2] = {{0, 0, 1}, {std::sin(turn), 0, std::cos(turn)}};
    Toys toys;
    toys.gravity_m_s2.setZero();
    for (const Vector3d& n : normals) toys.plane(n, {0, 0, 0}, 0, 1);
    // At distances from the planes that it covers within a step.
    Vector3d v(draw(-8, 8), 0, draw(-8, 8));
    double gap[2] = {draw(0.0005, 0.004), draw(0.0005, 0.004)};
    const double along = (r + gap[1] - std::cos(turn) * (r + gap[0])) / std::sin(turn);
    const int ball = toys.ball(0.1, r, {along, 0, r + gap[0]}, 0, 1);
    toys.world.free_body(ball).velocity_m_s = v;
    // Reflections, one after the other.
    double left = h, first_speed = 0;
    int bounces = 0;
    while (true) {
      int next = -1;
      double after = left;
      for (int k = 0; k < 2; ++k)
        if (const double s = normals[k].dot(v); s < 0 && gap[k] / -s < after) next = k, after = gap[k] / -s;
      for (int k = 0; k < 2; ++k) gap[k] += after * normals[k].dot(v);
      left -= after;
      if (next < 0) break;
      const double speed = -normals[next].dot(v);
      v += 2 * speed * normals[next];
      if (++bounces == 1) first_speed = speed;
      if (bounces == 2) slower_first += speed > first_speed;
    }
    toys.step(h);
    INFO("trial " << trial << ", " << bounces << " impacts");
    CHECK((toys.motion(ball).velocity_m_s - v).norm() < 1e-9);
    for (int k = 0; k < 2; ++k) CHECK(normals[k].dot(toys.motion(ball).centre_m) - r == Approx(gap[k]).margin(1e-11));
  }
  CHECK(slower_first > 20);
}

TEST_CASE("A ball that strikes a hanging rod follows the impact formula of the compound pendulum") {
  const double e = GENERATE(0.0, 0.5, 1.0), where = GENERATE(0.02, 0.05, 0.0667, 0.09);
  Toys toys;
  toys.gravity_m_s2.setZero();
  auto link = rod_link(-1, JointKind::kBall, {0, 0, 0}, {0, 0, -1});
  link.gravity_m_s2.setZero();
  const int rod = add_system(toys.world, articulated::ArticulatedSystem({link}));
  toys.capsule(rod, 0.1, 0.01, {0, 0, 1}, 0, e);
  const double m = 0.03, v = 2;
  // Without restitution a gap only closes within a step. This start puts the whole impact into one step.
  const int ball = toys.ball(m, 0.02, {e > 0 ? -0.0305 : -0.03, 0, -where}, 0, e);
  toys.world.free_body(ball).velocity_m_s = {v, 0, 0};
  // Angular momentum about the pivot and Newton's e: v' = v - J / m, w' = J where / I.
  const double inertia = link.inertia_kg_m2(1, 1) + link.mass_kg * 0.05 * 0.05;
  const double blow = (1 + e) * v / (1 / m + where * where / inertia);
  // One step with the impact inside. The rod rotates by half a millimetre after it.
  toys.step(0.001);
  const auto& rates = toys.world.system_of(rod).state().rates;
  CHECK(toys.world.free_body(ball).velocity_m_s.x() == Approx(v - blow / m).margin(1e-9));
  // About +y, x at -z grows by -w: the point at depth d moves with -w d.
  CHECK(rates[1] == Approx(-blow * where / inertia).epsilon(1e-9));
  CHECK(std::abs(rates[0]) < 1e-12);
}

TEST_CASE("A ball that strikes a free chain conserves momentum and gains no energy") {
  Toys toys;
  toys.gravity_m_s2.setZero();
  std::vector<articulated::LinkDef> links;
  for (int i = 0; i < 5; ++i) {
    links.push_back(rod_link(i - 1, JointKind::kBall, {0, 0, -0.1 * i}, {0, 0, -1}));
    links.back().gravity_m_s2.setZero();
  }
  links[0].is_free = true;
  const int chain = add_system(toys.world, articulated::ArticulatedSystem(links));
  for (int i = 0; i < 5; ++i) toys.capsule(chain + i, 0.1, 0.01, {0, 0, 1}, 0.3, 0.7);
  const int ball = toys.ball(0.1, 0.02, {-0.05, 0.004, -0.23}, 0.3, 0.7);
  auto& striker = toys.world.free_body(ball);
  striker.velocity_m_s = {3, 0, 0.4};
  auto& system = toys.world.system_of(chain);
  const auto momentum = [&] {
    Vector3d p = striker.mass_kg * striker.velocity_m_s;
    system.dynamics();
    for (int i = 0; i < 5; ++i) p += links[0].mass_kg * system.motion(i).velocity_m_s;
    return p;
  };
  const auto energy = [&] {
    return 0.5 * striker.mass_kg * striker.velocity_m_s.squaredNorm() +
           0.5 * 0.4 * striker.mass_kg * 0.02 * 0.02 * striker.spin_rad_s.squaredNorm() +
           kinetic_energy_J(system);
  };
  const Vector3d before = momentum();
  const double had = energy();
  bool struck = false;
  for (int i = 0; i < 100; ++i) {
    toys.step(0.001);
    struck |= striker.velocity_m_s.x() < 2.9;
    CHECK(energy() <= had * (1 + 1e-6));
  }
  CHECK(struck);
  // The impulses conserve it exactly. The integration of links that rotate at up to 100 rad/s has the error allowed
  // to a sub-step, 1e-4 of their rates, in practice a thousandth of that. The error has no fixed sign and does not
  // accumulate.
  CHECK((momentum() - before).norm() < 1e-7 * before.norm());
}

TEST_CASE("A fast body stops at the surface of a wall, also of a thin one") {
  const double h = GENERATE(0.001, 1.0 / 60), speed = GENERATE(1.0, 5.0, 20.0), e = GENERATE(0.0, 0.4);
  Toys toys;
  toys.plane({0, 0, 1}, {0, 0, 0}, 0.5, e);
  toys.plane({0, 0, -1}, {0, 0, 3}, 0.5, e);
  const int ball = toys.ball(0.05, 0.01, {0, 0, 1}, 0.5, e);
  const int box = toys.box(0.3, {0.1, 0.06, 0.04},
                           at(0.5, 0, 0.9) * Eigen::AngleAxisd(0.4, Vector3d(1, 2, 0.5).normalized()), 0.5, e);
  for (const int body : {ball, box}) toys.world.free_body(body).velocity_m_s = {0.3, 0, -speed};
  double least = 1;
  for (int i = 0; i < 1.5 / h; ++i) {
    toys.step(h);
    least = std::min(least, toys.min_gap_m());
  }
  INFO("h " << h << " speed " << speed << " e " << e << " least gap " << least);
  // Exact for the ball. A corner of a rotating box deviates from the linear path by (spin h)^2 / 2 of its arm per
  // step, which speculative contacts ignore, since they are linear.
  CHECK(toys.motion(ball).centre_m.z() > 0.01 - 1e-5);
  const double spin = 2 * speed / 0.04;
  CHECK(least > -1e-5 - 0.5 * std::min(1.0, spin * h * spin * h) * 0.06);
}
