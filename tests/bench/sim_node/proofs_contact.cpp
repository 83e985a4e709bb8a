// Proofs of friction and rest, and of joints.
#include <algorithm>
#include <cmath>

#include "tests/bench/sim_node/proofs.h"

namespace tactus::bench {
namespace {

using Eigen::Vector3d;
using Make = std::function<std::unique_ptr<Engine>()>;

constexpr double kH = 0.001;

Eigen::Isometry3d at(double x, double y, double z) { return Eigen::Isometry3d(Eigen::Translation3d(x, y, z)); }
Eigen::Isometry3d about_y(double angle) { return Eigen::Isometry3d(Eigen::AngleAxisd(angle, Vector3d::UnitY())); }

// A box on an incline: acceleration against g (sin - mu cos), or creep if it must stick. Over all yaws.
double incline(const Make& make, double factor) {
  const double theta = 0.3, mu = factor * std::tan(theta);
  double worst = 0;
  for (int k = 0; k < 16; ++k) {
    const auto e = make();
    const Eigen::Isometry3d tilt = about_y(theta);
    e->plane(tilt.linear() * Vector3d::UnitZ(), mu, 0);
    const Eigen::AngleAxisd yaw(M_PI / 2 * k / 16, Vector3d::UnitZ());
    const int box = e->box(0.5, {0.1, 0.1, 0.04}, tilt * at(0, 0, 0.02) * yaw, mu, 0);
    const Vector3d start = e->position(box);
    for (int i = 0; i < 500; ++i) e->step(kH);
    const Vector3d v = tilt.linear().transpose() * e->velocity(box),
                   x = tilt.linear().transpose() * (e->position(box) - start);
    if (factor > 1)
      worst = std::max(worst, x.head<2>().norm());
    else
      worst = std::max(worst, 100 * (v.head<2>() / 0.5 / (kG * (std::sin(theta) - mu * std::cos(theta))) -
                                     Eigen::Vector2d(1, 0))
                                        .norm());
  }
  return worst;
}

double cone(const Make& make) {
  double worst = 0;
  for (int k = 0; k < 48; ++k) {
    const auto e = make();
    e->plane({0, 0, 1}, 0.4, 0);
    const Eigen::AngleAxisd yaw(0.37 * k, Vector3d::UnitZ());
    const int box = e->box(2, {0.2, 0.1, 0.05}, at(0, 0, 0.025) * yaw, 0.4, 0);
    const Vector3d along(std::cos(2 * M_PI * k / 48), std::sin(2 * M_PI * k / 48), 0);
    e->set_motion(box, 2 * along, {0, 0, 0});
    for (int i = 0; i < 200; ++i) e->step(kH);
    worst = std::max(worst, 100 * std::abs((2 - e->velocity(box).dot(along)) / 0.2 / (0.4 * kG) - 1));
  }
  return worst;
}

double rolling(const Make& make) {
  double worst = 0;
  for (const double mu : {0.1, 0.4, 0.9}) {
    const auto e = make();
    e->plane({0, 0, 1}, mu, 0);
    const int ball = e->ball(0.3, 0.05, {0, 0, 0.05}, mu, 0);
    e->set_motion(ball, {2, 0, 0}, {0, 0, 0});
    for (int i = 0; i < 1000; ++i) e->step(kH);
    worst = std::max(worst, 100 * std::abs(e->velocity(ball).x() / (2 * 5.0 / 7) - 1));
  }
  return worst;
}

// Blocks on inclines on either side of tipping and of sliding: number of wrong outcomes.
double tipping(const Make& make) {
  const double width = 0.06, height = 0.2, edge = width / height;
  const auto tips = [&](double slope, double mu) {
    const auto e = make();
    const Eigen::Isometry3d tilt = about_y(std::atan(slope));
    e->plane(tilt.linear() * Vector3d::UnitZ(), mu, 0);
    const int block = e->box(1, {width, 0.1, height}, tilt * at(0, 0, height / 2), mu, 0);
    for (int i = 0; i < 700; ++i) e->step(kH);
    return (e->orientation(block) * Vector3d::UnitZ()).dot(tilt.linear() * Vector3d::UnitZ()) < 0.95;
  };
  return (tips(1.05 * edge, 1.2 * edge) ? 0 : 1) + (tips(0.97 * edge, 1.2 * edge) ? 1 : 0) +
         (tips(1.05 * edge, 0.9 * edge) ? 1 : 0) + (tips(2 * edge, 0.5 * edge) ? 1 : 0);
}

// Largest gain of energy of a rod that is pushed along with its tip on the floor, over slopes and frictions.
double painleve(const Make& make) {
  double worst = 0;
  for (const double mu : {1.0, 1.4, 2.0, 5.0})
    for (const double angle : {0.4, 0.8, 1.0, 1.2})
      for (const double speed : {-3.0, 3.0}) {
        const auto e = make();
        e->plane({0, 0, 1}, mu, 0);
        const double r = 0.005;
        const int rod = e->rod(1, 1, r, at(0, 0, 0.5 * std::sin(angle) + r) * about_y(angle), mu);
        e->set_motion(rod, {speed, 0, 0}, {0, 0, 0});
        const auto energy = [&] {
          const Vector3d w = e->orientation(rod).conjugate() * e->spin(rod);
          return e->velocity(rod).squaredNorm() / 2 +
                 Vector3d(r * r / 2, 1.0 / 12, 1.0 / 12).dot(w.cwiseAbs2()) / 2 + kG * e->position(rod).z();
        };
        const double start = energy();
        for (int i = 0; i < 1000; ++i) {
          e->step(kH);
          const double gain = energy() / start - 1;
          worst = std::isfinite(gain) ? std::max(worst, 100 * gain) : 1e9;
        }
      }
  return worst;
}

double weight(const Make& make) {
  const auto e = make();
  e->plane({0, 0, 1}, 0.5, 0);
  double sum = 0, felt = 0;
  for (int i = 0; i < 4; ++i) {
    e->box(1.7 - 0.3 * i, {0.1, 0.2, 0.1}, at(0.5 * i, 0, 0.05), 0.5, 0);
    sum += (1.7 - 0.3 * i) * kG;
  }
  for (int i = 0; i < 500; ++i) e->step(kH);
  for (int i = 0; i < 100; ++i) {
    e->step(kH);
    felt += e->contact_force_N() / 100;
  }
  return 100 * std::abs(felt / sum - 1);
}

// Displacement of the top of a stack, at h = 1/240 s.
double stack(const Make& make, int n, double seconds) {
  const auto e = make();
  e->plane({0, 0, 1}, 0.5, 0);
  int top = 0;
  for (int i = 0; i < n; ++i) top = e->box(0.5, {0.1, 0.1, 0.1}, at(0, 0, 0.05 + 0.1 * i), 0.5, 0);
  for (int i = 0; i < 240 * seconds; ++i) e->step(1.0 / 240);
  return 1000 * (e->position(top) - Vector3d(0, 0, 0.1 * n - 0.05)).norm();
}

double chain(const Make& make, double about_vertical) {
  const auto e = make();
  e->chain(11, about_vertical);
  const double start = e->chain_energy_J(), scale = 0.05 * kG * 0.1 * 121 / 2;
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    e->step(kH);
    worst = std::max(worst, 100 * std::abs(e->chain_energy_J() - start) / scale);
  }
  return worst;
}

double chain_gap(const Make& make) {
  const auto e = make();
  e->chain(11, 0.5);
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    e->step(kH);
    worst = std::max(worst, 1000 * e->joint_gap_m());
  }
  return worst;
}

double period(const Make& make) {
  double worst = 0;
  for (const double amplitude : {0.3, 1.5, 2.8}) {
    const auto e = make();
    e->pendulum(amplitude);
    const double inertia = 0.05 * (3e-4 + 1e-2) / 12 + 0.05 * 0.0025;
    const double truth = 4 * std::sqrt(inertia / (0.05 * kG * 0.05)) * std::comp_ellint_1(std::sin(amplitude / 2));
    double first = -1, end = 0, last = amplitude;
    int crossings = 0;
    for (int i = 1; crossings < 6 && i < 20000; ++i) {
      e->step(kH);
      const double now = e->pendulum_angle_rad();
      if (last < 0 && now >= 0) {
        end = (i - now / (now - last)) * kH;
        if (first < 0) first = end;
        ++crossings;
      }
      last = now;
    }
    worst = std::max(worst, crossings == 6 ? 100 * std::abs((end - first) / 5 / truth - 1) : 100);
  }
  return worst;
}

// A ball strikes a hung rod without gravity, `depth` below its joint.
struct Blow {
  static constexpr double kBallMass = 0.03, kSpeed_m_s = 2;
  static constexpr double kRodInertia = 0.05 * (3e-4 + 1e-2) / 12 + 0.05 * 0.0025;  // about the joint

  Blow(const Make& make, double restitution, double depth) : e(make()) {
    e->set_gravity({0, 0, 0});
    e->hanging_rod(restitution);
    ball = e->ball(kBallMass, 0.02, {-0.0315, 0, -depth}, 0, restitution);
    e->set_motion(ball, {kSpeed_m_s, 0, 0}, {0, 0, 0});
  }
  // About the joint and the y axis.
  double angular_momentum() const {
    return kBallMass * e->position(ball).cross(e->velocity(ball)).y() + kRodInertia * e->link_spin().y();
  }
  std::unique_ptr<Engine> e;
  int ball = -1;
};

// Velocity of the ball against that after the impact on a compound pendulum.
double percussion(const Make& make) {
  double worst = 0;
  for (const double c : {0.5, 1.0})
    for (const double depth : {0.02, 0.05, 0.09}) {
      const Blow blow(make, c, depth);
      const double m = Blow::kBallMass, v = Blow::kSpeed_m_s;
      const double impulse = (1 + c) * v / (1 / m + depth * depth / Blow::kRodInertia);
      for (int i = 0; i < 3; ++i) blow.e->step(kH);
      worst = std::max(worst, 100 * std::abs((blow.e->velocity(blow.ball).x() - (v - impulse / m)) / v));
    }
  return worst;
}

// Angular momentum: the loss of the ball equals the gain of the link. 100 % when they miss each other.
double link_momentum(const Make& make, const std::vector<double>& restitutions) {
  double worst = 0;
  for (const double c : restitutions)
    for (const double depth : {0.02, 0.05, 0.09}) {
      const Blow blow(make, c, depth);
      const double before = blow.angular_momentum();
      for (int i = 0; i < 3; ++i) blow.e->step(kH);
      const bool met = blow.e->velocity(blow.ball).x() < 0.99 * Blow::kSpeed_m_s;
      worst = std::max(worst, met ? 100 * std::abs(blow.angular_momentum() / before - 1) : 100);
    }
  return worst;
}

}  // namespace

std::vector<Proof> contact_proofs(double stand_s) {
  const auto standing = [stand_s](int n) { return [n, stand_s](const Make& m) { return stack(m, n, stand_s); }; };
  return {
      {"incline, mu 0.8 tan: acceleration, 16 yaws", "%", 2, "g (sin - mu cos), straight down",
       "design: 1/20 of the 41 % of a pyramid", [](const Make& m) { return incline(m, 0.8); }},
      {"incline, mu 1.001 tan: creep in 0.5 s", "m", 1e-5, "none",
       "design: half of the distance that counts as motion in snapshots (20 um)",
       [](const Make& m) { return incline(m, 1.001); }},
      {"cone: braking at 48 headings and yaws", "%", 2, "mu g", "the same as on the incline", cone},
      {"ball slides, then rolls", "%", 0.1, "5/7 v0, whatever mu", "design: 1/3000 of v0", rolling},
      {"blocks with the wrong outcome", "of 4", 0, "tips when mu and slope > w/h", "none is permitted", tipping},
      {"Painleve's rods: gain of energy", "%", 1, "none", "leapfrog sways by h g / v = 0.3 %", painleve},
      {"resting boxes: sum of forces", "%", 0.01, "m g", "design: below a force sensor's 0.1 %", weight},
      {"stack of 5, 1/240 s: top moved", "mm", 1, "stands", "design: 0.2 mm per box, visible at arm's length",
       standing(5)},
      {"stack of 10, 1/240 s: top moved", "mm", 2, "stands", "the same", standing(10)},
      {"stack of 20, 1/240 s: top moved", "mm", 4, "stands", "the same", standing(20)},
  };
}

std::vector<Proof> joint_proofs() {
  return {
      {"pendulum, 0.3, 1.5, 2.8 rad: period", "%", 0.01, "4 sqrt(I/mgl) K(sin(a/2))",
       "design: 0.1 ms of a second, a tenth of a step", period},
      {"chain of 22 DOF, planar, 5 s: energy", "%", 1, "kept", "design: MuJoCo's RK4 keeps 0.04 %; ODE loses 46 %",
       [](const Make& m) { return chain(m, 0); }},
      {"chain of 22 DOF, 0.5 rad/s, 5 s: energy", "%", 1, "kept",
       "design: MuJoCo's RK4 keeps 0.7 %; ODE loses 27 %", [](const Make& m) { return chain(m, 0.5); }},
      {"chain of 22 DOF: joint gap", "mm", 0, "none", "joint coordinates have none", chain_gap},
      {"ball strikes a hung rod: its velocity", "%", 0.1, "(1+e) v / (1/m + d^2/I)", "design: 1/1000 of its speed",
       percussion},
      {"ball off a link: angular momentum", "%", 1e-10, "kept", "rounding: 1e-16, some thousand times",
       [](const Make& m) {
         return link_momentum(m, {0.5, 1.0});
       }},
      {"ball stays on a link: angular momentum", "%", 1e-4, "kept",
       "an impact inside a step acts at the poses of the start of the step: design, 1/50 of ODE's",
       [](const Make& m) { return link_momentum(m, {0.0}); }},
  };
}

}  // namespace tactus::bench
