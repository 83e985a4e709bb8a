#include "sim_node/behaviour/solver.h"

#include <catch2/catch.hpp>
#include <cstring>

#include "sync/bus/identity.h"
#include "tests/sim_node/support/small_worlds.h"
#include "tests/sim_node/support/solver_steps.h"

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

double total_force(const Solver& solver) {
  double sum = 0;
  for (const Manifold& m : solver.solved())
    for (const ManifoldPoint& p : m.used()) sum += p.normal_force_N;
  return sum;
}

}  // namespace

TEST_CASE("A free body follows the parabola at every step") {
  Settings settings;
  settings.solver = GENERATE("impulse", "quick");
  WorldDef w = empty_world();
  const int ball = add_ball(w, 0.3, 0.02, {0, 0, 50});
  w.bodies[0].velocity_m_s = {1, -2, 3};
  Solver solver(w, settings);
  double worst = 0;
  for (int n = 1; n <= 2000; ++n) {
    solver.step();
    const double t = n * kStep;
    const Vector3d exact = Vector3d(0, 0, 50) + t * Vector3d(1, -2, 3) + 0.5 * t * t * Vector3d(0, 0, -kG);
    worst = std::max(worst, (body(solver, ball).position_m - exact).norm());
  }
  // The step is exact for constant acceleration. The rest is the rounding of 2000 sums of order 50: 2000 * 50 *
  // 2^-53.
  CHECK(worst < 1.2e-11);
}

TEST_CASE("A body rotates about its centre of mass, also if its origin is elsewhere") {
  Settings settings;
  settings.solver = GENERATE("impulse", "quick");
  WorldDef w = empty_world(0);
  const int b = add_body(w, "club", 2, Eigen::Matrix3d::Identity() * 0.1, at(1, 2, 3));
  w.bodies[0].centre_of_mass_m = {0.3, 0, 0};
  Solver solver(w, settings);
  CHECK((body(solver, b).centre_m - Vector3d(1.3, 2, 3)).norm() < 1e-12);
  // A force couple about z: one second at 0.1 N m rotates it by 1/2 alpha t (t + h), the sum of the steps.
  for (int i = 0; i < 1000; ++i) {
    solver.add_force(b, {0, 0.05, 0}, body(solver, b).centre_m + Vector3d(1, 0, 0));
    solver.add_force(b, {0, -0.05, 0}, body(solver, b).centre_m - Vector3d(1, 0, 0));
    solver.step();
  }
  CHECK((body(solver, b).centre_m - Vector3d(1.3, 2, 3)).norm() < 1e-9);
  CHECK(body(solver, b).spin_rad_s.z() == Approx(1).epsilon(1e-9));
  const double angle = Eigen::AngleAxisd(body(solver, b).orientation).angle();
  CHECK(angle == Approx(0.5 * 1.001).epsilon(1e-6));
  CHECK((body(solver, b).position_m - body(solver, b).to_world({0, 0, 0})).norm() < 1e-15);
  CHECK(((body(solver, b).position_m - body(solver, b).centre_m).norm()) == Approx(0.3));
}

TEST_CASE("A box on an incline sticks or slides as tan(theta) predicts, for any yaw") {
  Settings settings;
  settings.solver = GENERATE("impulse", "quick");
  const double theta = 0.3;
  for (const double yaw : {0.0, 0.3, std::numbers::pi / 4, 1.1}) {
    for (const double factor : {1.05, 0.8}) {
      WorldDef w = empty_world();
      const double mu = factor * std::tan(theta);
      const Eigen::Isometry3d tilt(Eigen::AngleAxisd(theta, Vector3d::UnitY()));
      const int floor = add_floor(w, mu);
      w.bodies[static_cast<std::size_t>(floor)].pose = tilt;
      const Vector3d size(0.1, 0.1, 0.04);
      const Eigen::Isometry3d pose = tilt * at(0, 0, 0.02) * Eigen::AngleAxisd(yaw, Vector3d::UnitZ());
      const int box = add_box(w, 0.5, size, pose, mu);
      Solver solver(w, settings);
      const Vector3d start = body(solver, box).position_m;
      run(solver, 0.5);
      const Vector3d moved = tilt.linear().transpose() * (body(solver, box).position_m - start);
      INFO("yaw " << yaw << " mu/tan " << factor << " moved " << moved.transpose());
      if (factor > 1) {
        // Creep: the residual of the iterations in each step's g h sin(theta).
        CHECK(moved.head<2>().norm() < 2e-4);
      } else {
        // Slides with g (sin - mu cos) straight down, within 3 % of friction and 3 degrees.
        const double a = kG * (std::sin(theta) - mu * std::cos(theta));
        CHECK(moved.x() == Approx(0.5 * a * 0.25).epsilon(0.03));
        CHECK(std::abs(moved.y()) < 0.05 * moved.x());
      }
    }
  }
}

TEST_CASE("A ball rebounds with the smaller restitution of the pair") {
  Settings settings;
  settings.solver = GENERATE("impulse", "quick");
  for (const double e : {0.0, 0.5, 0.8, 1.0}) {
    WorldDef w = empty_world();
    add_floor(w, 0.5, 1.0);
    const double r = 0.03, height = 0.5;
    const int ball = add_ball(w, 0.2, r, {0, 0, r + height}, 0.5, e);
    Solver solver(w, settings);
    run(solver, std::sqrt(2 * height / kG) + 0.005);
    double top = 0;
    for (int i = 0; i < 700 && body(solver, ball).velocity_m_s.z() > -0.05; ++i) {
      top = std::max(top, body(solver, ball).position_m.z() - r);
      solver.step();
    }
    // The bounce uses the speed at the end of a step: at most one step of gravity too much in v, twice that in
    // height. It starts within the overlap of a step minus the surface layer, m.
    const double v = std::sqrt(2 * kG * height);
    INFO("e " << e);
    CHECK(top == Approx(e * e * height).margin(2 * e * e * height * kG * kStep / v + 2e-4));
  }
}

TEST_CASE("The contact force on a resting body equals its weight") {
  Settings settings;
  settings.solver = GENERATE("impulse", "quick");
  WorldDef w = empty_world();
  add_floor(w);
  const int box = add_box(w, 1.7, {0.1, 0.2, 0.1}, at(0, 0, 0.05));
  Solver solver(w, settings);
  run(solver, 1);
  double sum = 0;
  for (int i = 0; i < 100; ++i) {
    solver.step();
    sum += total_force(solver) / 100;
  }
  // Exact in the mean, or the body would move; 1e-4 for a body that still settles by 1 mm/s over the 0.1 s.
  CHECK(sum == Approx(1.7 * kG).epsilon(1e-3));
  CHECK(body(solver, box).velocity_m_s.norm() < 1e-3);
  CHECK(body(solver, box).position_m.z() == Approx(0.05).margin(3e-4));
}

TEST_CASE("A stack of five boxes stands for ten seconds") {
  Settings settings;
  settings.solver = GENERATE("impulse", "quick");
  WorldDef w = empty_world();
  add_floor(w);
  for (int i = 0; i < 5; ++i) add_box(w, 0.5, {0.1, 0.1, 0.1}, at(0, 0, 0.05 + 0.1 * i));
  Solver solver(w, settings);
  run(solver, 10);
  for (int i = 1; i <= 5; ++i) {
    const Vector3d p = body(solver, i).position_m;
    CHECK(std::hypot(p.x(), p.y()) < 2e-3);
    // Each contact yields by the surface layer and the residual of the iterations.
    CHECK(p.z() == Approx(0.1 * i - 0.05).margin(1e-3 * i));
  }
}

TEST_CASE("A pendulum swings with the period of the elliptic integral") {
  WorldDef w = empty_world();
  const double mass = 0.4, r = 0.02, length = 0.5, amplitude = 1;
  const Vector3d start(length * std::sin(amplitude), 0, -length * std::cos(amplitude));
  const int bob = add_ball(w, mass, r, start);
  add_joint(w, JointKind::kRevolute, -1, bob, {0, 0, 0}, {0, 1, 0});
  Settings settings;
  Solver solver(w, settings);
  // T = 4 sqrt(I / (m g l)) K(sin(amplitude / 2)).
  const double inertia = 0.4 * mass * r * r + mass * length * length;
  const double period = 4 * std::sqrt(inertia / (mass * kG * length)) * std::comp_ellint_1(std::sin(amplitude / 2));
  double last = 0, crossings = 0, first = -1, time = 0;
  for (int i = 1; crossings < 9; ++i) {
    REQUIRE(i < 20000);
    solver.step();
    const double x = body(solver, bob).position_m.x();
    if (last > 0 && x <= 0) {
      time = (i - x / (x - last)) * kStep;
      if (first < 0) first = time;
      ++crossings;
    }
    last = x;
  }
  // The step is symplectic: the period error is (omega h)^2 / 24 = 8e-7; ERP and CFM of the joint add less than 1e-3.
  CHECK((time - first) / 8 == Approx(period).epsilon(1e-3));
}

TEST_CASE("A chain of eleven universal joints stays connected") {
  Settings settings;
  settings.solver = GENERATE("impulse", "quick");
  WorldDef w = chain_world(11);
  Solver solver(w, settings);
  double worst = 0;
  for (int i = 0; i < 3000; ++i) {
    // Swung by its end.
    if (i < 300) solver.add_force(10, {0.5, 0.2, 0}, body(solver, 10).centre_m);
    solver.step();
    worst = std::max(worst, largest_joint_gap_m(w, solver.bodies()));
  }
  CHECK(worst < 1e-3);
  CHECK(body(solver, 10).position_m.allFinite());
  // Joints keep the energy of the swing: the end never rises above the height that the work lifts it to.
  CHECK(body(solver, 10).position_m.z() < 2);
}

TEST_CASE("Joints obey limits, friction and dampers") {
  WorldDef w = empty_world(0);
  Settings settings;
  settings.solver = GENERATE("impulse", "quick");
  const int wheel = add_body(w, "wheel", 1, Eigen::Matrix3d::Identity() * 0.01, at(0, 0, 0));
  JointDef& joint = add_joint(w, JointKind::kRevolute, -1, wheel, {0, 0, 0}, {0, 0, 1});
  const auto torque = [&](Solver& s, double n_m) {
    s.add_force(wheel, {0, n_m / 2, 0}, {1, 0, 0});
    s.add_force(wheel, {0, -n_m / 2, 0}, {-1, 0, 0});
  };
  const auto angle = [&](const Solver& s) {
    const Eigen::Quaterniond q = body(s, wheel).orientation;
    return 2 * std::atan2(q.z(), q.w());
  };
  SECTION("a stop limits the angle") {
    joint.axes[0].lower = -0.5;
    joint.axes[0].upper = 0.7;
    Solver solver(w, settings);
    for (int i = 0; i < 2000; ++i) {
      torque(solver, 0.05);
      solver.step();
    }
    CHECK(angle(solver) == Approx(0.7).margin(5e-3));
  }
  SECTION("Coulomb friction holds a smaller torque and reduces a larger one") {
    joint.axes[0].friction = 0.1;
    Solver solver(w, settings);
    for (int i = 0; i < 500; ++i) {
      torque(solver, 0.09);
      solver.step();
    }
    CHECK(std::abs(angle(solver)) < 1e-6);
    for (int i = 0; i < 500; ++i) {
      torque(solver, 0.15);
      solver.step();
    }
    // With impulses the spin is the mean over a step, which lags by half a step, and breakaway takes one step.
    CHECK(body(solver, wheel).spin_rad_s.z() == Approx(0.05 / 0.01 * 0.5).margin(0.05 / 0.01 * kStep));
  }
  SECTION("a damper decays exponentially, in ODE at the rate of the implicit step") {
    joint.axes[0].damping = 0.02;
    Solver solver(w, settings);
    for (int i = 0; i < 100; ++i) {
      torque(solver, 1);
      solver.step();
    }
    // With impulses the spin is the mean over a step: this is one without the drive.
    solver.step();
    const double start = body(solver, wheel).spin_rad_s.z();
    run(solver, 1);
    const double truth = settings.solver == "quick" ? std::pow(1 + 0.02 * kStep / 0.01, -1000) : std::exp(-2);
    // One step assumes that the drive continues: (h d / I)^2 = 4e-6 of the rate for each of the first steps.
    CHECK(body(solver, wheel).spin_rad_s.z() / start == Approx(truth).epsilon(1e-4));
  }
  SECTION("a motor reaches its speed with its torque") {
    joint.axes[0].motor_velocity = 3;
    joint.axes[0].motor_effort = 0.05;
    Solver solver(w, settings);
    run(solver, 0.2);
    CHECK(body(solver, wheel).spin_rad_s.z() == Approx(0.05 / 0.01 * 0.2).epsilon(1e-3));
    run(solver, 2);
    CHECK(body(solver, wheel).spin_rad_s.z() == Approx(3).epsilon(1e-3));
  }
  SECTION("a very stiff spring stays stable") {
    joint.axes[0].stiffness = 1e7;
    joint.axes[0].reference = 0.1;
    Solver solver(w, settings);
    run(solver, 1);
    CHECK(angle(solver) == Approx(0.1).margin(1e-3));
  }
}

TEST_CASE("Two runs of one world are bit-identical") {
  const auto digest = [] {
    WorldDef w = empty_world();
    add_floor(w, 0.5, 0.3);
    for (int i = 0; i < 20; ++i)
      add_box(w, 0.2 + 0.01 * i, {0.1, 0.08, 0.06}, at(0.03 * (i % 3), 0.02 * (i % 4), 0.1 + 0.11 * i), 0.4, 0.2);
    for (int i = 0; i < 10; ++i) add_ball(w, 0.1, 0.04, {0.5 + 0.05 * (i % 2), 0.01 * i, 0.1 + 0.1 * i}, 0.4, 0.7);
    Solver solver(w, {});
    std::vector<double> states;
    for (int i = 0; i < 600; ++i) {
      solver.step();
      for (const BodyMotion& b : solver.bodies())
        for (int k = 0; k < 3; ++k) states.insert(states.end(), {b.position_m[k], b.velocity_m_s[k], b.spin_rad_s[k]});
    }
    return tactus::sync::fnv1a_64(states.data(), states.size() * sizeof(double));
  };
  const auto first = digest();
  CHECK(first == digest());
}

TEST_CASE("Two bodies that collide in free space conserve momentum") {
  Settings settings;
  settings.solver = GENERATE("impulse", "quick");
  WorldDef w = empty_world(0);
  const int a = add_ball(w, 0.3, 0.05, {-0.2, 0, 0}, 0.5, 0.6), b = add_ball(w, 0.7, 0.05, {0.2, 0.02, 0}, 0.5, 0.6);
  w.bodies[0].velocity_m_s = {1, 0, 0};
  w.bodies[1].velocity_m_s = {-0.5, 0.1, 0};
  Solver solver(w, settings);
  const Vector3d before = 0.3 * w.bodies[0].velocity_m_s + 0.7 * w.bodies[1].velocity_m_s;
  run(solver, 0.6);
  const Vector3d after = 0.3 * body(solver, a).velocity_m_s + 0.7 * body(solver, b).velocity_m_s;
  CHECK((after - before).norm() < 1e-12);
  CHECK(body(solver, a).velocity_m_s.x() < 0);
}

TEST_CASE("A body with an invalid mass is rejected with its name") {
  WorldDef w = empty_world();
  add_body(w, "ghost", 1, -Eigen::Matrix3d::Identity(), at(0, 0, 0));
  CHECK_THROWS_WITH(Solver(w, {}), Catch::Contains("ghost"));
}
