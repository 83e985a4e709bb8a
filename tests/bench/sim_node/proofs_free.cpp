// Proofs of flight and collision.
#include <algorithm>
#include <cmath>

#include "tests/bench/sim_node/proofs.h"

namespace tactus::bench {
namespace {

using Eigen::Vector3d;
using Make = std::function<std::unique_ptr<Engine>()>;

constexpr double kH = 0.001;

Eigen::Isometry3d at(double x, double y, double z) { return Eigen::Isometry3d(Eigen::Translation3d(x, y, z)); }

double parabola(const Make& make) {
  const auto e = make();
  const int ball = e->ball(0.3, 0.02, {0, 0, 50}, 0.5, 0);
  e->set_motion(ball, {1, -2, 3 + kH / 2 * kG}, {0, 0, 0});
  double worst = 0;
  for (int n = 1; n <= 2000; ++n) {
    e->step(kH);
    const double t = n * kH;
    worst = std::max(worst, (e->position(ball) - Vector3d(t, -2 * t, 50 + 3 * t - kG * t * t / 2)).norm());
  }
  return worst;
}

// Energy of an asymmetric body without torque, over 10 s.
double top(const Make& make) {
  const auto e = make();
  e->set_gravity({0, 0, 0});
  const Vector3d size(0.1, 0.2, 0.4), q = size.cwiseAbs2();
  const Vector3d inertia = 2.0 / 12 * Vector3d(q.y() + q.z(), q.x() + q.z(), q.x() + q.y());
  const int box = e->box(2, size, at(0, 0, 0), 0.5, 0);
  e->set_motion(box, {0, 0, 0}, {0.05, 6, 0.1});
  const auto energy = [&] {
    const Vector3d w = e->orientation(box).conjugate() * e->spin(box);
    return w.cwiseAbs2().dot(inertia) / 2;
  };
  const double start = energy();
  double worst = 0;
  for (int i = 0; i < 10000; ++i) {
    e->step(kH);
    worst = std::max(worst, std::abs(energy() / start - 1));
  }
  return 100 * worst;
}

// Heights of the first five bounces against e^2n, at 60 Hz.
double bounces(const Make& make) {
  const auto e = make();
  const double r = 0.03, height = 2, c = 0.8, h = 1.0 / 60;
  e->plane({0, 0, 1}, 0.5, c);
  const int ball = e->ball(0.2, r, {0, 0, r + height}, 0.5, c);
  e->set_motion(ball, {0, 0, h / 2 * kG}, {0, 0, 0});
  double worst = 0;
  int bounce = 0;
  Vector3d before = e->velocity(ball);
  for (int i = 0; i < 2000 && bounce < 5; ++i) {
    e->step(h);
    const Vector3d v = e->velocity(ball);
    if (before.z() < -0.1 && v.z() > 0.1) {
      ++bounce;
      // Height of the apex from here: the velocity is that of the middle of the step.
      const double now = v.z() - h / 2 * kG, top_m = e->position(ball).z() - r + now * now / (2 * kG);
      worst = std::max(worst, std::abs(top_m / (height * std::pow(c, 2 * bounce)) - 1));
    }
    before = v;
  }
  return bounce == 5 ? 100 * worst : 100;
}

// Duration of five hops after the first fall: t0 (1 + 2 e + 2 e^2 ...) up to the point where it stops bouncing.
double zeno(const Make& make) {
  const auto e = make();
  const double r = 0.03, height = 0.5, c = 0.7;
  e->plane({0, 0, 1}, 0.5, c);
  const int ball = e->ball(0.2, r, {0, 0, r + height}, 0.5, c);
  const double fall = std::sqrt(2 * height / kG), truth = fall * (1 + c) / (1 - c);
  double last_s = 0;
  for (int i = 1; i < 4000; ++i) {
    e->step(kH);
    if (std::abs(e->velocity(ball).z()) > 0.02) last_s = i * kH;
  }
  return std::abs(last_s - truth);
}

double cradle(const Make& make, int arriving, double apart) {
  const auto e = make();
  e->set_gravity({0, 0, 0});
  for (int i = 0; i < 5; ++i) {
    e->ball(0.1, 0.02, {(0.04 + apart) * i - (i < arriving ? 0.002 : 0), 0, 0}, 0.5, 1);
    if (i < arriving) e->set_motion(i, {1, 0, 0}, {0, 0, 0});
  }
  for (int i = 0; i < 40; ++i) e->step(kH);
  double worst = 0;
  for (int i = 0; i < 5; ++i)
    worst = std::max(worst, (e->velocity(i) - Vector3d(i >= 5 - arriving ? 1 : 0, 0, 0)).norm());
  return worst;
}

double momentum(const Make& make) {
  const auto e = make();
  e->set_gravity({0, 0, 0});
  const int a = e->ball(0.3, 0.05, {-0.2, 0, 0}, 0.4, 0.6), b = e->ball(0.7, 0.08, {0.2, 0.03, 0.01}, 0.4, 0.6);
  e->set_motion(a, {1, 0, 0}, {3, 20, -7});
  e->set_motion(b, {-0.5, 0.1, 0}, {0, 0, 0});
  const auto sum = [&] { return Vector3d(0.3 * e->velocity(a) + 0.7 * e->velocity(b)); };
  const Vector3d before = sum();
  for (int i = 0; i < 600; ++i) e->step(kH);
  return e->velocity(a).x() < 0 ? (sum() - before).norm() : 1;
}

double penetration(const Make& make, double h) {
  double worst = 0;
  for (const double speed : {1.0, 5.0, 20.0}) {
    const auto e = make();
    e->plane({0, 0, 1}, 0.5, 0);
    const int ball = e->ball(0.05, 0.01, {0, 0, 1}, 0.5, 0);
    e->set_motion(ball, {0.3, 0, -speed}, {0, 0, 0});
    for (int i = 0; i < 1.2 / h; ++i) {
      e->step(h);
      worst = std::max(worst, 0.01 - e->position(ball).z());
    }
  }
  return 1e6 * worst;
}

}  // namespace

std::vector<Proof> free_proofs() {
  return {
      {"parabola, 2 s: farthest off", "m", 1.2e-11, "y0 + v t - g t^2/2", "rounding: 2000 half ulps of 50 m",
       parabola},
      {"asymmetric top, 10 s: energy", "%", 0.01, "kept (Euler)", "design: 1/400 of ODE's 4 %", top},
      {"bounces, e 0.8, 60 Hz: height of five", "%", 1, "e^2n", "design: 0.5 % of speed, 0.04 dB of sound",
       bounces},
      {"Zeno time, e 0.7, 1 ms", "s", 0.02, "t0 (1+e)/(1-e)",
       "hops below 0.02 m/s take 2 v/g/(1-e) = 0.014 s; some steps", zeno},
      {"cradle, 1 of 5, touching", "m/s", 1e-9, "one leaves", "rounding, amplified by five collisions",
       [](const Make& m) { return cradle(m, 1, 0); }},
      {"cradle, 2 of 5, touching", "m/s", 1e-9, "two leave", "the same",
       [](const Make& m) { return cradle(m, 2, 0); }},
      {"cradle, 3 of 5, touching", "m/s", 1e-9, "three leave", "the same",
       [](const Make& m) { return cradle(m, 3, 0); }},
      {"cradle, 1 of 5, 0.1 mm apart", "m/s", 1e-9, "one leaves", "the same",
       [](const Make& m) { return cradle(m, 1, 1e-4); }},
      {"two bodies meet: momentum", "kg m/s", 1e-12, "kept", "rounding: 600 steps of 1 kg m/s at 1e-16", momentum},
      {"overlap at 1, 5, 20 m/s, 1 ms", "um", 10, "none", "design: half of the 20 um that snapshots call moved",
       [](const Make& m) { return penetration(m, kH); }},
      {"overlap at 1, 5, 20 m/s, 60 Hz", "um", 10, "none", "the same",
       [](const Make& m) { return penetration(m, 1.0 / 60); }},
  };
}

}  // namespace tactus::bench
