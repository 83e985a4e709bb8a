#include "sim_node/touch/tool_push.h"

#include <catch2/catch.hpp>
#include <random>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_applied_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/behaviour/solver.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

// A haptic process that presses on one contact, and a free ball of 0.2 kg in empty space that it pushes.
struct Rig {
  Settings settings;
  Ids ids{5};
  std::int64_t contact = ids.next_id();
  WorldDef world = empty_world(0);
  int ball = add_ball(world, 0.2, 0.05, {0, 0, 0});
  Solver solver{world, settings};
  ToolPush push{settings, ids, {0.06}};
  std::int64_t tick = 0, haptic_ns = 0, seq = 0, incarnation = 77;
  Vector3d reported{0, 0, 0};  // cumulative impulse on the tool
  std::vector<Vector3d> forces;

  // One haptic tick with this force on the tool.
  tool_state_t message(const Vector3d& force_N, double dt = 0.001, const Vector3d& off_centre = {0, 0, 0}) {
    reported += force_N * dt;
    haptic_ns += std::llround(dt * 1e9);
    tool_state_t m{};
    m.header.incarnation = incarnation;
    m.header.seq = seq++;
    m.header.publish_time_ns = haptic_ns;
    tool_constraint_t c{};
    c.contact_id = contact;
    c.body = ball;
    c.point_m = to_vec3f(solver.bodies()[0].centre_m + off_centre);
    c.force_N = to_vec3f(force_N);
    c.impulse_N_s = to_vec3f(reported);
    m.constraints = {c};
    m.constraint_count = 1;
    return m;
  }
  Vector3d step(std::vector<tool_state_t> messages) {
    Vector3d sum = Vector3d::Zero();
    for (const Push& p : push.step(sync::sim_time(tick * std::int64_t{1'000'000}), messages, solver.bodies())) {
      solver.add_force(p.body, p.force_N, p.point_m);
      sum += p.force_N;
    }
    solver.step();
    push.add_work(solver.bodies());
    ++tick;
    forces.push_back(sum);
    return sum;
  }
  Vector3d momentum() const { return 0.2 * solver.bodies()[0].velocity_m_s; }
  touch_applied_t applied() const {
    std::vector<touch_applied_t> out;
    push.applied_impulses(out, 8);
    return out.empty() ? touch_applied_t{} : out[0];
  }
};

}  // namespace

TEST_CASE("A tool that pushes a free ball transfers exactly the impulse on the tool") {
  const int pattern = GENERATE(0, 1, 2);
  Rig rig;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<tool_state_t> pending;
  for (int i = 0; i < 200; ++i) {
    pending.push_back(rig.message({u(random), 2 + u(random), 0.3 * u(random)}));
    // 0: one message per step; 1: none, then two; 2: at random, with one message in ten lost.
    const bool deliver = pattern == 0 || (pattern == 1 && i % 2 == 1) || (pattern == 2 && u(random) > -0.3);
    if (pattern == 2 && u(random) > 0.8) pending.pop_back();
    rig.step(deliver ? pending : std::vector<tool_state_t>{});
    if (deliver) pending.clear();
  }
  // The force has ended; the total settles in the following steps.
  for (int i = 0; i < 150; ++i) rig.step({rig.message({0, 0, 0})});
  const tool_state_t last = rig.message({0, 0, 0});
  const Vector3d reported = to_eigen(last.constraints[0].impulse_N_s);  // with the precision of the wire format
  INFO("reported " << reported.transpose() << " got " << rig.momentum().transpose());
  CHECK((rig.momentum() + reported).norm() < 1e-9);
  CHECK((to_eigen(rig.applied().impulse_N_s) + reported).norm() < 1e-6);
  // The work equals the energy of the ball; it does not spin, because the force acts through its centre.
  CHECK(rig.applied().energy_J == Approx(rig.momentum().squaredNorm() / 0.4).epsilon(1e-5));
}

TEST_CASE("A constant force stays constant when its messages arrive in pairs") {
  Rig rig;
  std::vector<tool_state_t> pending;
  for (int i = 0; i < 100; ++i) {
    pending.push_back(rig.message({0, 0, -3}));
    rig.step(i % 2 ? pending : std::vector<tool_state_t>{});
    if (i % 2) pending.clear();
  }
  for (std::size_t i = 30; i < rig.forces.size(); ++i) CHECK(rig.forces[i].z() == Approx(3).epsilon(0.25));
}

TEST_CASE("A haptic loop of 4 kHz applies the correct force") {
  Rig rig;
  for (int i = 0; i < 50; ++i) {
    std::vector<tool_state_t> messages;
    for (int k = 0; k < 4; ++k) messages.push_back(rig.message({0, 0, -2}, 0.00025));
    rig.step(messages);
  }
  CHECK(rig.forces.back().z() == Approx(2).epsilon(1e-4));
  CHECK(rig.momentum().z() == Approx(0.1).epsilon(1e-3));
}

TEST_CASE("Without messages the force is held for 5 ms and then fades in 5 ms") {
  Rig rig;
  for (int i = 0; i < 10; ++i) rig.step({rig.message({0, 0, -4})});
  for (int silent = 1; silent < 20; ++silent) {
    const double force = rig.step({}).z();
    INFO("silent for " << silent << " ms");
    CHECK(force == Approx(4 * std::clamp(1 - (silent - 5) / 5.0, 0.0, 1.0)).margin(1e-6));
  }
  SECTION("an impulse after a long silence is not applied at once") {
    for (int i = 0; i < 80; ++i) rig.message({0, 0, -4});
    double largest = 0;
    for (int i = 0; i < 20; ++i) largest = std::max(largest, rig.step({rig.message({0, 0, -4})}).norm());
    CHECK(largest < 3 * 4);
  }
}

TEST_CASE("A new haptic process starts its impulses from zero") {
  Rig rig;
  for (int i = 0; i < 20; ++i) rig.step({rig.message({0, 0, -4})});
  tool_state_t old = rig.message({0, 0, -4});
  const double before = rig.momentum().z();
  rig.incarnation = 78;
  rig.reported.setZero();
  rig.seq = 0;
  rig.haptic_ns += 400'000'000;
  rig.step({rig.message({0, 0, -1})});
  CHECK(rig.forces.back().z() == Approx(1).epsilon(1e-5));
  CHECK(rig.momentum().z() - before == Approx(0.001).epsilon(1e-4));
  // A late message of the old process changes nothing.
  rig.step({old, rig.message({0, 0, -1})});
  CHECK(rig.forces.back().z() == Approx(1).epsilon(1e-4));
  // A repeated message changes nothing.
  const tool_state_t twice = rig.message({0, 0, -1});
  rig.step({twice, twice});
  CHECK(rig.forces.back().z() == Approx(1).epsilon(1e-4));
}

TEST_CASE("Hostile push messages have limited effect") {
  Rig rig;
  SECTION("the force is limited, and the excess is not applied later") {
    for (int i = 0; i < 20; ++i) CHECK(rig.step({rig.message({0, 0, -1e6})}).norm() <= rig.settings.tool_force_limit_N + 1e-9);
  }
  SECTION("the point is moved to the body") {
    for (int i = 0; i < 20; ++i) rig.step({rig.message({0, 0, -1}, 0.001, {1e6, 0, 0})});
    // Torque at largest force times the reach of 0.06 m.
    const double inertia = 0.4 * 0.2 * 0.05 * 0.05;
    CHECK(rig.solver.bodies()[0].spin_rad_s.norm() <= 0.020 * 1 * 0.06 / inertia * 1.001);
  }
  SECTION("contacts of another simulation are ignored") {
    rig.contact = sync::prefixed_id(9, 0);
    CHECK(rig.step({rig.message({0, 0, -1})}).norm() == 0);
  }
  SECTION("unknown contacts are ignored") {
    rig.contact += 10;
    CHECK(rig.step({rig.message({0, 0, -1})}).norm() == 0);
  }
  SECTION("unknown bodies are ignored") {
    rig.ball = 17;
    CHECK(rig.step({rig.message({0, 0, -1})}).norm() == 0);
  }
}
