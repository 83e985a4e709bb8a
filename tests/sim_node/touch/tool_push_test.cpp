#include "sim_node/touch/tool_push.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <tactus/tool_constraint_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_applied_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/behaviour/solver.h"
#include "sim_node/touch/tool_senders.h"
#include "tests/sim_node/support/small_worlds.h"

using namespace tactus;
using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Vector3d;

namespace {

constexpr std::int64_t kRun = 7;

// A haptic process: its clock, its numbers, and a sum of the impulse for each contact.
struct Process {
  std::int64_t incarnation;
  std::int64_t ns = 5'000'000'000, seq = 0;
  struct Sum {
    std::int64_t since_ns;
    Vector3d reported{0, 0, 0};
  };
  std::map<std::int64_t, Sum> sums{};

  // A message without a force.
  tool_state_t idle(double dt = 0.001) {
    ns += std::llround(dt * 1e9);
    tool_state_t m{};
    m.header.run_id = kRun;
    m.header.incarnation = incarnation;
    m.header.seq = seq++;
    m.header.publish_time_ns = ns;
    return m;
  }
  // One tick with this force of a contact on the tool.
  tool_state_t message(std::int64_t contact, int body, const Vector3d& point, const Vector3d& force_N, double dt = 0.001) {
    Sum& sum = sums.try_emplace(contact, Sum{ns + 1}).first->second;
    sum.reported += force_N * dt;
    tool_state_t m = idle(dt);
    tool_constraint_t c{};
    c.contact_id = contact;
    c.body = body;
    c.point_m = to_vec3(point);
    c.force_N = to_vec3f(force_N);
    c.impulse_N_s = to_vec3(sum.reported);
    c.impulse_since_ns = sum.since_ns;
    m.constraints = {c};
    m.constraint_count = 1;
    return m;
  }
};

std::vector<tool_def_t> one_tool() {
  tool_def_t tool{};
  tool.name = "finger";
  return {tool};
}

// A haptic process that presses on one contact, and a free ball of 0.2 kg in empty space that it pushes.
struct Rig {
  Settings settings;
  Ids ids{5};
  std::int64_t contact = ids.next_id();
  WorldDef world = empty_world(0);
  int ball = add_ball(world, 0.2, 0.05, {0, 0, 0});
  Solver solver{world, settings};
  ToolPush push{settings, ids, {0.06}};
  ToolSenders senders{one_tool(), kRun};
  Process process{77};
  std::int64_t tick = 0;
  std::vector<Vector3d> forces;
  std::vector<Push> pushes;  // of the last step

  Rig() { step({process.idle()}); }

  // One haptic tick with this force on the tool.
  tool_state_t message(const Vector3d& force_N, double dt = 0.001, const Vector3d& off_centre = {0, 0, 0}) {
    return message_of(process, force_N, dt, off_centre);
  }
  tool_state_t message_of(Process& p, const Vector3d& force_N, double dt = 0.001, const Vector3d& off_centre = {0, 0, 0}) {
    return p.message(contact, ball, solver.bodies()[0].centre_m + off_centre, force_N, dt);
  }
  Vector3d step(const std::vector<tool_state_t>& messages) {
    std::vector<tool_state_t> used;
    for (const tool_state_t& m : messages)
      if (senders.accept(m, now())) used.push_back(m);
    Vector3d sum = Vector3d::Zero();
    pushes = push.step(sync::sim_time(tick * std::int64_t{1'000'000}), used, solver.bodies());
    for (const Push& p : pushes) {
      solver.add_force(p.body, p.force_N, p.point_m);
      sum += p.force_N;
    }
    solver.step();
    push.add_work(solver.bodies());
    ++tick;
    forces.push_back(sum);
    return sum;
  }
  sync::HostTime now() const { return sync::host_time((1000 + tick) * std::int64_t{1'000'000}); }
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
  const Vector3d reported = rig.process.sums.at(rig.contact).reported;
  INFO("reported " << reported.transpose() << " got " << rig.momentum().transpose());
  CHECK((rig.momentum() + reported).norm() < 1e-9);
  CHECK((to_eigen(rig.applied().impulse_N_s) + reported).norm() < 1e-9);
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

TEST_CASE("A second haptic process of a tool changes nothing for the first one, at any time") {
  Rig rig;
  Process second{78};
  Vector3d felt = Vector3d::Zero();
  for (int ms = 0; ms < 2500; ++ms) {
    const Vector3d force(0, 0, -4.47);
    felt += 0.001 * force;
    std::vector<tool_state_t> messages{rig.message(force)};
    // It lives for a second, and its messages arrive before and after those of the first one.
    if (ms >= 500 && ms < 1500) messages.insert(messages.begin() + ms % 2, rig.message_of(second, {0, 0, 2}));
    rig.step(messages);
    const bool changes = ms >= 1790 && ms < 1810;  // 0.3 s after the last message of the second one
    if (!changes) CHECK(rig.senders.conflict_text(rig.now()).empty() == (ms < 500 || ms >= 1800));
    if (ms > 10) REQUIRE(rig.forces.back().z() == Approx(4.47).epsilon(1e-6));
  }
  for (int i = 0; i < 100; ++i) rig.step({rig.message({0, 0, 0})});
  CHECK((rig.momentum() + felt).norm() < 1e-9);
}

TEST_CASE("A successor of a silent haptic process pushes, and the first one pushes again after it") {
  Rig rig;
  Process second{78, 9'000'000'000};
  second.message(rig.contact, rig.ball, {0, 0, 0}, {0, 0, -50'000});  // given before the simulation receives it
  for (int i = 0; i < 100; ++i) rig.step({rig.message({0, 0, -4})});
  Vector3d before = rig.momentum();
  for (int i = 0; i < 299; ++i) CHECK(rig.step({rig.message_of(second, {0, 0, -1})}).z() <= 4 + 1e-9);
  CHECK(rig.momentum().z() - before.z() < 0.041);  // the held and fading force of the first one
  before = rig.momentum();
  for (int i = 0; i < 100; ++i) rig.step({rig.message_of(second, {0, 0, -1})});
  for (int i = 0; i < 100; ++i) rig.step({rig.message_of(second, {0, 0, 0})});
  CHECK(rig.momentum().z() - before.z() == Approx(0.1).epsilon(0.02));  // without its first message
  before = rig.momentum();
  const tool_state_t late = rig.message({0, 0, -4});
  for (int i = 0; i < 299; ++i) rig.step({late});
  CHECK((rig.momentum() - before).norm() < 1e-9);
  for (int i = 0; i < 100; ++i) rig.step({rig.message({0, 0, -4})});
  for (int i = 0; i < 100; ++i) rig.step({rig.message({0, 0, 0})});
  CHECK(rig.momentum().z() - before.z() == Approx(0.4).epsilon(0.02));
}

TEST_CASE("Repeated and late messages of a haptic process and messages of another run change nothing") {
  Rig rig;
  tool_state_t late = rig.message({0, 0, -1});
  for (int i = 0; i < 20; ++i) rig.step({rig.message({0, 0, -1})});
  tool_state_t recorded = rig.message({0, 0, -100});
  recorded.header.run_id = kRun + 1;
  recorded.header.incarnation = 5;
  rig.process.sums.at(rig.contact).reported += Vector3d(0, 0, 0.1);
  rig.step({recorded, rig.message({0, 0, -1})});
  const tool_state_t twice = rig.message({0, 0, -1});
  rig.step({twice, late, twice, recorded});
  rig.step({late, twice, rig.message({0, 0, -1})});
  for (int i = 0; i < 100; ++i) rig.step({rig.message({0, 0, 0})});
  CHECK((rig.momentum() + rig.process.sums.at(rig.contact).reported).norm() < 1e-9);
  CHECK(rig.senders.conflict_text(rig.now()).empty());
}

TEST_CASE("A contact whose sum the simulation has forgotten is not pushed a second time") {
  Rig rig;
  std::vector<std::int64_t> contacts{rig.contact};
  for (int i = 1; i < 150; ++i) contacts.push_back(rig.ids.next_id());
  Vector3d felt = Vector3d::Zero();
  for (int round = 0; round < 2; ++round)
    for (const std::int64_t contact : contacts)
      for (int i = 0; i < 20; ++i) {
        // The last messages of a contact have no force, so that its whole impulse is applied.
        const Vector3d force(0, 0, i < 5 ? -0.5 : 0);
        rig.step({rig.process.message(contact, rig.ball, rig.solver.bodies()[0].centre_m, force)});
        // Of a forgotten sum, the message that names it first sets the start.
        if (round == 0 || i > 0) felt += 0.001 * force;
      }
  CHECK((rig.momentum() + felt).norm() < 0.01 * felt.norm());
}

TEST_CASE("A haptic process with an impulse from before it was received pushes only from then on") {
  Rig rig;
  Process second{78};
  for (int i = 0; i < 400; ++i) rig.step({});
  second.message(rig.contact, rig.ball, {0, 0, 0}, {0, 0, -80'000});  // 80 N s
  for (int i = 0; i < 100; ++i) CHECK(rig.step({rig.message_of(second, {0, 0, 0})}).norm() == 0);
  CHECK(rig.momentum().norm() == 0);
}

TEST_CASE("The impulse of a contact whose first messages are lost is applied completely") {
  Rig rig;
  for (int i = 0; i < 3; ++i) rig.message({0, 0, -2});  // lost
  for (int i = 0; i < 50; ++i) rig.step({rig.message({0, 0, -2})});
  for (int i = 0; i < 100; ++i) rig.step({rig.message({0, 0, 0})});
  CHECK(rig.momentum().z() == Approx(0.106).epsilon(1e-6));
}

TEST_CASE("A force that is held for an hour is applied exactly") {
  Rig rig;
  rig.step({rig.message({0, 0, 0})});
  rig.process.sums.at(rig.contact).reported.z() = -8 * 3600;  // N s; single precision resolves 0.002 N s there
  for (int i = 0; i < 500; ++i) rig.step({rig.message({0, 0, -8})});
  for (std::size_t i = 100; i < rig.forces.size(); ++i) CHECK(rig.forces[i].z() == Approx(8).margin(1e-6));
}

TEST_CASE("A simulation that was stopped applies at most the force limit times its own time") {
  Rig rig;
  for (int i = 0; i < 50; ++i) rig.step({rig.message({0, 0, -8})});
  const double before = rig.momentum().z();
  std::vector<tool_state_t> waiting;
  for (int i = 0; i < 2000; ++i) waiting.push_back(rig.message({0, 0, -8}));
  rig.step(waiting);
  for (int i = 0; i < 100; ++i) rig.step({rig.message({0, 0, 0})});
  CHECK(rig.momentum().z() - before <= rig.settings.tool_force_limit_N * 0.002);
}

TEST_CASE("No messages of any senders push harder or longer than the limits") {
  Rig rig;
  std::mt19937_64 random(5);
  const auto whole = [&](std::int64_t low, std::int64_t high) { return std::uniform_int_distribution<std::int64_t>(low, high)(random); };
  const auto number = [&] { return std::pow(10.0, static_cast<double>(whole(-6, 9))) * (random() % 2 ? 1 : -1); };
  const double limit_N = rig.settings.tool_force_limit_N;
  for (int i = 0; i < 63; ++i) rig.ids.next_id();
  int received = 0;
  for (int i = 0; i < 50'000; ++i) {
    std::vector<tool_state_t> messages;
    for (std::int64_t n = whole(0, 3); n > 0 && i % 1000 < 900; --n) {
      tool_state_t m{};
      m.header.run_id = whole(0, 9) == 0 ? 1 : kRun;
      m.header.incarnation = whole(0, 9) < 8 ? 77 : static_cast<std::int64_t>(random() >> 2) + 1;
      m.header.seq = whole(0, 9) < 8 ? ++rig.process.seq : static_cast<std::int64_t>(random() >> 1);
      m.header.publish_time_ns = whole(0, 9) < 8 ? rig.process.ns += 1'000'000 : static_cast<std::int64_t>(random() >> 4);
      tool_constraint_t c{};
      c.contact_id = sync::prefixed_id(5, whole(0, 80));
      c.body = static_cast<std::int32_t>(whole(0, 1));
      c.impulse_N_s = to_vec3({number(), number(), number()});
      c.impulse_since_ns = whole(0, 1) ? m.header.publish_time_ns : 0;
      m.constraints = {c};
      m.constraint_count = 1;
      messages.push_back(m);
    }
    received += !messages.empty();
    rig.step(messages);
    for (const Push& p : rig.pushes) REQUIRE(p.force_N.norm() <= limit_N * (1 + 1e-12));
    if (i % 1000 > 912) CHECK(rig.forces.back().norm() == 0);
    REQUIRE(rig.momentum().allFinite());
  }
  CHECK(received > 10'000);
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
    rig.step({rig.message({0, 0, 0})});
    CHECK(rig.step({rig.message({0, 0, -1})}).norm() == 0);
  }
  SECTION("unknown contacts are ignored") {
    rig.contact += 10;
    rig.step({rig.message({0, 0, 0})});
    CHECK(rig.step({rig.message({0, 0, -1})}).norm() == 0);
  }
  SECTION("unknown bodies are ignored") {
    rig.ball = 17;
    rig.step({rig.message({0, 0, 0})});
    CHECK(rig.step({rig.message({0, 0, -1})}).norm() == 0);
  }
}
