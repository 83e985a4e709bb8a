#include "haptic_node/safety/passivity.h"

#include <catch2/catch.hpp>
#include <random>
#include <tactus/touch_applied_t.hpp>
#include <tactus/touch_model_t.hpp>

#include "tests/haptic_node/support/episode.h"
#include "tests/haptic_node/support/tick.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

// A hand and one body, both with motion set by the test, joined by a spring through an observer. The energy of the
// body is reported at once, or never.
struct Ports {
  explicit Ports(double mass_kg, double stiffness_N_m = 1000) : mass_kg(mass_kg), stiffness_N_m(stiffness_N_m) {}

  // The hand is `in` under the surface of the body. Since the last tick it moved by moved_m (up: positive) and the
  // body by body_m.
  double tick(double in, double moved_m, double body_m, bool reported = true) {
    given_J += -force * body_m;
    impulse -= force * kDt;
    age_s = reported ? 0 : age_s + kDt;
    if (reported) {
      auto p = plane(7, Vector3d::Zero(), Vector3d::UnitZ());
      p.effective_mass_kg = static_cast<float>(mass_kg);
      p.velocity_m_s = to_vec3f(Vector3d(0, 0, body_m / kDt));
      touch_model_t m = model(ms, {p});
      touch_applied_t a{};
      a.contact_id = 7;
      a.energy_J = given_J;
      a.impulse_N_s = to_vec3(Vector3d(0, 0, impulse));
      m.applied = {a};
      passivity.on_message(m);
    }
    ++ms;
    std::vector<Surface> surfaces(1);
    surfaces[0].contact_id = 7;
    surfaces[0].effective_mass_kg = mass_kg;
    surfaces[0].depth_m = std::max(0.0, in);
    surfaces[0].coupling_stiffness_N_m = stiffness_N_m;
    const double deep = std::max(0.0, in);
    const StoredEnergy stored{0.5 * stiffness_N_m * deep * deep, deep > 0};
    if (lever_m > 0)
      passivity.observe(stored, Vector3d::Zero(), {0, -moved_m / lever_m, 0}, age_s, kDt);
    else
      passivity.observe(stored, {0, 0, moved_m}, Vector3d::Zero(), age_s, kDt);
    force = passivity.factor() * stiffness_N_m * std::max(0.0, in);
    const std::vector<ContactForce> felt{{7, 0, {lever_m, 0, 0}, {0, 0, force}}};
    const Vector3d about = Vector3d::Zero();
    passivity.record(felt, surfaces, lever_m > 0 ? &about : nullptr);
    return force;
  }

  // If not 0, the hand moves its end by rotation.
  double lever_m = 0;

  double mass_kg, stiffness_N_m;
  double force = 0, given_J = 0, impulse = 0, age_s = 0;
  int ms = 0;
  Passivity passivity{PassivityLimits{}};
};

constexpr Network kHard[] = {{"10 ms late", 10},
                             {"50 ms late", 50},
                             {"30 Hz", 0, 30},
                             {"30 % lost in bursts", 0, 1000, true},
                             {"frozen", 0, 1000, false, true},
                             {"25 ms late, 30 Hz", 25, 30}};

}  // namespace

TEST_CASE("A pressed and released spring generates only the energy of the hold over a tick") {
  Ports ports(1);
  double in = 0;
  for (int k = 0; k < 200; ++k) {
    const double next = 0.005 * std::pow(std::sin(M_PI * k / 200), 2);
    ports.tick(next, in - next, 0);
    in = next;
    // No damper compensates the energy from holding the force over a tick: K T / 2 times the integral of v^2, 0.31
    // mJ a press.
    REQUIRE(ports.passivity.factor() == 1);
    REQUIRE(ports.passivity.generated_J() < 3.2e-4);
  }
}

TEST_CASE("A force without a source counts as generated and gives at most the allowance") {
  Ports ports(1);
  // The surface is suddenly 5 mm above the hand and retreats at 0.1 m/s: 12.5 mJ.
  double hand_J = 0;
  for (int k = 0; k < 50; ++k) {
    const double force = ports.tick(0.005 - 1e-4 * k, 1e-4, 0);
    hand_J += force * 1e-4;
  }
  CHECK(hand_J > 0.0001);
  CHECK(hand_J < 0.0015);
  CHECK(ports.passivity.generated_J() == Approx(hand_J).margin(0.0004));
}

TEST_CASE("Work by rotation counts like work by translation") {
  Ports straight(1), lever(1);
  lever.lever_m = 0.1;
  // Pushed along at 0.5 m/s, and 5 mm deep within one tick: more than the allowance, although the path alone
  // generates nothing.
  for (int k = 0; k < 20; ++k) {
    straight.tick(0.005, -5e-4, -5e-4);
    lever.tick(0.005, -5e-4, -5e-4);
    CAPTURE(k);
    CHECK(lever.passivity.factor() == Approx(straight.passivity.factor()).margin(1e-9));
    CHECK(lever.passivity.generated_J() == Approx(straight.passivity.generated_J()).margin(1e-9));
  }
  CHECK(straight.passivity.factor() > 0);
  CHECK(straight.passivity.factor() < 1);
}

TEST_CASE("The last of two reports of a body counts, and its speed is clamped") {
  const bool twice = GENERATE(true, false);
  // Suddenly pressed by 10 mm, without energy from hand or body, on 0.05 kg.
  const auto factor = [&](bool wrong_report) {
    Ports ports(0.05);
    for (int k = 0; k < 3; ++k) ports.tick(0.0005, 0, 0);
    if (wrong_report) {
      auto p = plane(7, Vector3d::Zero(), Vector3d::UnitZ());
      auto first = p;
      p.effective_mass_kg = 0.05f;
      first.effective_mass_kg = 9e8f;
      if (!twice) p.velocity_m_s = to_vec3f(Vector3d(0, 0, 1e9));
      touch_model_t m = model(ports.ms, twice ? std::vector{first, p} : std::vector{p});
      touch_applied_t a{};
      a.contact_id = 7;
      a.energy_J = ports.given_J;
      a.impulse_N_s = to_vec3(Vector3d(0, 0, ports.impulse));
      m.applied = {a};
      ports.passivity.on_message(m);
    }
    for (int k = 0; k < 20; ++k) ports.tick(0.01, 0, 0, false);
    return ports.passivity.factor();
  };
  if (twice) CHECK(factor(true) == factor(false));
  // 10 m/s give at most 8 N a millisecond at a time; 1e9 m/s would cover everything.
  if (!twice) CHECK(factor(true) < 1);
}

TEST_CASE("Energy from a body does not count as generated") {
  // A falling ball of 1 kg at 0.5 m/s pushes the hand away at the same speed, pressed 3 mm in: 1.5 W for 0.2 s.
  Ports ports(1);
  for (int k = 0; k < 30; ++k) ports.tick(1e-4 * k, -1e-4, 0);  // the hand presses first
  for (int k = 0; k < 200; ++k) ports.tick(0.003, 5e-4, 5e-4);
  CHECK(ports.passivity.factor() == 1);
  CHECK(ports.passivity.generated_J() < 1e-4);
}

TEST_CASE("Without reports the push on a light body ends soon, for a held body later than for a free body") {
  const bool held = GENERATE(false, true);
  Ports ports(0.1);
  double v = 0;
  for (int k = 0; k < 50; ++k) ports.tick(1e-4 * k, -1e-4, 0);  // a wall behind it
  for (int k = 0; k < 100; ++k) {
    if (!held) v -= ports.force / 0.1 * kDt;
    ports.tick(0.005, v * kDt, v * kDt);
  }
  int until = 0;
  while (until < 300 && ports.tick(0.005, v * kDt, v * kDt, false) > 0.5) ++until;
  CAPTURE(held, until);
  CHECK(until >= (held ? 30 : 0));
  CHECK(until < (held ? 150 : 30));
}

TEST_CASE("An episode restarts after a time without contact, and earlier energy does not count") {
  Ports ports(1);
  for (int k = 0; k < 30; ++k) ports.tick(1e-4 * k, -1e-4, 0);
  for (int k = 0; k < 100; ++k) ports.tick(0.003, -5e-4, -5e-4);  // pushed along: the body has received 150 mJ
  for (int k = 0; k < 300; ++k) ports.tick(0, 0, 0);
  for (int k = 0; k < 30; ++k) ports.tick(1e-4 * k, -1e-4, 0);
  CHECK(ports.passivity.factor() == 1);
  CHECK(ports.passivity.generated_J() < 1e-4);
}

TEST_CASE("Values that are not finite do not change the factor") {
  Passivity passivity{PassivityLimits{}};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  touch_model_t m = model(0, {plane(7, Vector3d::Zero(), Vector3d::UnitZ())});
  touch_applied_t a{};
  a.contact_id = 7;
  a.energy_J = nan;
  m.applied = {a};
  passivity.on_message(m);
  m.applied[0].energy_J = 0;
  m.planes[0].velocity_m_s.z = nan;
  passivity.on_message(m);
  passivity.observe({}, {nan, 0, 0}, Vector3d::Zero(), 0, kDt);
  CHECK(passivity.factor() == 1);
  CHECK(passivity.generated_J() == 0);
}

TEST_CASE("Degraded touch generates at most 1 mJ and does not oscillate") {
  // passivity_table has the whole grid; here a random part of it.
  std::mt19937 random(11);
  const auto pick = [&](const auto& from) { return from[random() % std::size(from)]; };
  constexpr double kMasses[] = {0.05, 0.1, 0.2, 0.5, 1};
  for (int round = 0; round < 60; ++round) {
    EpisodeDef def;
    def.act = static_cast<Act>(random() % 3);
    def.mass_kg = pick(kMasses);
    def.network = pick(kHard);
    def.hand = hand_kinds()[random() % hand_kinds().size()].impedance;
    const EpisodeResult r = run_episode(def);
    CAPTURE(static_cast<int>(def.act), def.mass_kg, def.network.name, def.hand.mass_kg);
    CHECK(r.generated_mJ <= 1);
    if (def.act == Act::kPress) CHECK_FALSE(r.cycles());
    CHECK(r.peak_N > 0.01);
  }
}

TEST_CASE("Long losses at a moving body neither generate energy nor end the contact") {
  // Each of these cases once generated more than 1 mJ, kept oscillating, or left no force.
  const auto run = [](Act act, double mass_kg, std::size_t hand, unsigned seed) {
    EpisodeDef def;
    def.act = act, def.mass_kg = mass_kg, def.seed = seed;
    def.network = {"30 % lost in bursts", 0, 1000, true};
    def.hand = hand_kinds()[hand].impedance;
    return run_episode(def);
  };
  constexpr std::size_t kFinger = 1, kArm = 3;
  CHECK(run(Act::kTap, 1, kArm, 2).generated_mJ <= 1);
  CHECK(run(Act::kTap, 0.2, kArm, 7).generated_mJ <= 1);
  CHECK_FALSE(run(Act::kPress, 1, kFinger, 2).cycles());
  CHECK(run(Act::kPush, 0.05, kArm, 8).pushed_m > 0.5 * kPush_m);
}

TEST_CASE("Without a disturbance the controller does not change the coupling") {
  for (const double mass_kg : {0.0, 0.05, 0.2, 1.0})
    for (const HandKind& hand : hand_kinds()) {
      EpisodeDef def;
      def.mass_kg = mass_kg;
      def.hand = hand.impedance;
      CAPTURE(mass_kg, hand.name);
      CHECK(run_episode(def).least_coupling == 1);
    }
}
