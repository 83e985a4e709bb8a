// Tests of the hand of a recorded run: a hand of known impedance and intention in closed loop with a wall.
#include "scripts/virtual_time/rerun_hand.h"

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <random>
#include <tactus/touch_model_t.hpp>

#include "sync/degradation/stage_signal.h"
#include "tests/sync/support/log_of_run.h"
#include "tests/sync/support/temporary_folder.h"

using namespace tactus;
using Eigen::Vector3d;
using haptic::HandImpedance;
using haptic::MonotoneCubic;

namespace {

constexpr double kTick_s = 0.001;

sync::HostTime rerun_ms(int ms) { return sync::HostTime{} + sync::Nanoseconds(1'000'000LL * ms); }

struct KnownHand {
  HandImpedance impedance;
  MonotoneCubic intention;
  double wall_N_m = 0;    // a wall below z = 0
  int delay_ticks = 1;    // from the tick of a motion to the tick from which its force acts
};

KnownHand drawn_hand(unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  std::vector<double> times_s{0};
  std::vector<Vector3d> points_m{{0, 0, 0.02}};
  while (times_s.back() < 3) {
    times_s.push_back(times_s.back() + draw(0.15, 0.5));
    points_m.emplace_back(draw(-0.03, 0.03), draw(-0.03, 0.03), draw(-0.02, 0.03));
  }
  const double damping_N_s_m = draw(8, 40);
  // The wall is late by at most 5 ms: with K tau < B the loop is stable, so that it does not amplify rounding errors.
  return {{.mass_kg = draw(0.05, 1), .damping_N_s_m = damping_N_s_m, .stiffness_N_m = draw(50, 800)},
          MonotoneCubic(times_s, points_m, MonotoneCubic::Ends::kRest), draw(0.1, 0.9) * damping_N_s_m / 0.005, 1 + static_cast<int>(random() % 5)};
}

Vector3d wall_force(double wall_N_m, const Vector3d& position_m) { return {0, 0, -wall_N_m * std::min(0.0, position_m.z())}; }

// One tick of m x'' = -k (x - r) - b (x' - r') + F for a target r that moves uniformly and a constant force, by the exponential of
// the matrix of (x, x', r, r', F), as a Taylor series.
Eigen::Matrix<double, 5, 5> exact_step(const HandImpedance& h) {
  Eigen::Matrix<double, 5, 5> a = Eigen::Matrix<double, 5, 5>::Zero();
  a(0, 1) = a(2, 3) = 1;
  a.row(1) << -h.stiffness_N_m, -h.damping_N_s_m, h.stiffness_N_m, h.damping_N_s_m, 1;
  a.row(1) /= h.mass_kg;
  Eigen::Matrix<double, 5, 5> term = Eigen::Matrix<double, 5, 5>::Identity(), sum = term;
  for (int n = 1; n < 40; ++n) sum += term = Eigen::Matrix<double, 5, 5>(term * a * (kTick_s / n));
  return sum;
}

// The log of the hand: its position at each tick.
std::vector<Vector3d> log_of(const KnownHand& hand, int ticks) {
  const Eigen::Matrix<double, 5, 5> step = exact_step(hand.impedance);
  std::vector<Vector3d> positions{hand.intention.at(0).position};
  Vector3d velocity = Vector3d::Zero();
  for (int i = 0; i + 1 < ticks; ++i) {
    const Vector3d r = hand.intention.at(i * kTick_s).position, next = hand.intention.at((i + 1) * kTick_s).position;
    const int felt = i - hand.delay_ticks;
    const Vector3d force = felt < 0 ? Vector3d(Vector3d::Zero()) : wall_force(hand.wall_N_m, positions[static_cast<std::size_t>(felt)]);
    Vector3d position;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Matrix<double, 5, 1> s;
      s << positions.back()[axis], velocity[axis], r[axis], (next[axis] - r[axis]) / kTick_s, force[axis];
      const Eigen::Matrix<double, 5, 1> after = step * s;
      position[axis] = after[0];
      velocity[axis] = after[1];
    }
    positions.push_back(position);
  }
  return positions;
}

// The same hand as rerun_hand runs it, with the operators of a profile on its force.
std::vector<Vector3d> rerun(const KnownHand& hand, int ticks, const std::string& attributes) {
  sync::OperatorChain operators(
      sync::parse_profile("<profile><degrade modality=\"haptic\" stage=\"force\" " + attributes + "/></profile>", "p.xml"), "haptic", {}, "force");
  sync::StageSignal displayed;
  // The node receives a force in the tick after that of its motion; the rest of the delay is that of rerun_hand.
  RerunHand again(hand.intention, hand.impedance, sync::Nanoseconds(1'000'000LL * (hand.delay_ticks - 1)));
  again.begin(rerun_ms(0));
  std::vector<Vector3d> positions;
  for (int i = 0; i < ticks; ++i) {
    positions.push_back(again.tick(rerun_ms(i)).position);
    sync::ForceSample force;
    force.force_N = wall_force(hand.wall_N_m, positions.back());
    again.push(rerun_ms(i + 1), displayed.step(rerun_ms(i), sync::sim_time(1'000'000LL * i), force, operators).force_N);
  }
  return positions;
}

}  // namespace

TEST_CASE("A hand of known impedance and intention in closed loop reproduces its log without degradation") {
  int contacts = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const KnownHand hand = drawn_hand(seed);
    INFO("seed " << seed << ", " << hand.impedance.mass_kg << " kg, " << hand.impedance.damping_N_s_m << " N s/m, " << hand.impedance.stiffness_N_m
                 << " N/m, wall " << hand.wall_N_m << " N/m, " << hand.delay_ticks << " ms late");
    const auto log = log_of(hand, 3000), again = rerun(hand, 3000, "delay=\"0\"");
    for (std::size_t i = 0; i < log.size(); ++i) {
      REQUIRE((log[i] - again[i]).norm() < 1e-9);
      contacts += log[i].z() < 0;
    }
  }
  CHECK(contacts > 10'000);
}

TEST_CASE("A gain of a half changes the place and the force of a hand that presses a linear wall as in the closed form") {
  constexpr int kRest_ticks = 30'000;  // the slowest hand has the time constant 40 / 50 s
  for (unsigned seed = 1; seed <= 20; ++seed) {
    KnownHand hand = drawn_hand(seed);
    hand.wall_N_m *= 0.4;  // so that the late wall takes at most 0.36 of the damping, and the hand comes to rest
    const double k = hand.impedance.stiffness_N_m, wall = hand.wall_N_m, depth_m = 0.002 + 0.001 * seed;
    // At rest k (z + d) = g K |z|, so z = -d k / (k + g K).
    hand.intention = MonotoneCubic({0, 1, 100}, {{0, 0, 0.02}, {0, 0, -depth_m}, {0, 0, -depth_m}}, MonotoneCubic::Ends::kRest);
    const double whole_m = rerun(hand, kRest_ticks, "delay=\"0\"").back().z(), half_m = rerun(hand, kRest_ticks, "gain=\"0.5 force\"").back().z();
    INFO("seed " << seed);
    CHECK(whole_m == Approx(-depth_m * k / (k + wall)).margin(1e-9));
    CHECK(half_m == Approx(-depth_m * k / (k + 0.5 * wall)).margin(1e-9));
    CHECK(half_m - whole_m == Approx(-depth_m * k * 0.5 * wall / ((k + wall) * (k + 0.5 * wall))).margin(1e-9));
    CHECK(0.5 * wall * -half_m - wall * -whole_m == Approx(-depth_m * k * k * 0.5 * wall / ((k + wall) * (k + 0.5 * wall))).margin(1e-6));
  }
}

TEST_CASE("A force acts from its arrival and its delay on, and the newest one of a tick counts") {
  DelayedForce felt(sync::Nanoseconds(2'000'000));
  felt.push(rerun_ms(1), {1, 0, 0});
  felt.push(rerun_ms(2), {2, 0, 0});
  felt.push(rerun_ms(3), {3, 0, 0});
  CHECK_FALSE(felt.take(rerun_ms(2)));
  CHECK((felt.take(rerun_ms(3)) == Vector3d(1, 0, 0)));
  CHECK_FALSE(felt.take(rerun_ms(3)));
  CHECK((felt.take(rerun_ms(9)) == Vector3d(3, 0, 0)));
  CHECK_FALSE(felt.take(rerun_ms(99)));
}

TEST_CASE("A hand whose force is no longer renewed is free after 20 ms") {
  RerunHand hand(MonotoneCubic({0, 1}, {{0, 0, 0}, {0, 0, 0}}, MonotoneCubic::Ends::kRest), {.mass_kg = 0.1, .damping_N_s_m = 10, .stiffness_N_m = 300}, {});
  hand.begin(rerun_ms(0));
  hand.push(rerun_ms(0), {3, 0, 0});
  for (int i = 0; i < 20; ++i) hand.tick(rerun_ms(i));
  const double pushed_m = hand.tick(rerun_ms(20)).position.x();
  CHECK(pushed_m > 0.003);
  for (int i = 21; i < 2000; ++i) hand.tick(rerun_ms(i));  // a force that stayed would hold it at 0.01 m
  CHECK(std::abs(hand.tick(rerun_ms(2000)).position.x()) < 1e-9);
}

TEST_CASE("The commands of a log come at their times after its first touch model, and those before it at once") {
  sync::TemporaryFolder folder;
  sync::TestRun of_run;
  sync::TestEvents events = events_of(of_run);
  const auto add = [&](const std::string& channel, double after_s, auto message) {
    message.header = sync::header_of("sim_node", 9, 0, of_run.begin_ns + static_cast<std::int64_t>(1e9 * after_s), of_run.run_id);
    events.push_back({(message.header.publish_time_ns + of_run.offset_ns) / 1000, channel, sync::encode(message)});
  };
  sim_command_t pause{}, resume{};
  pause.kind = sim_command_t::PAUSE;
  resume.kind = sim_command_t::RESUME;
  pause.id = 1;
  resume.id = 2;
  add(channels::kSimCommand, 0.5, pause);
  add(channels::kTouchModel, 1.0, touch_model_t{});
  add(channels::kTouchModel, 1.1, touch_model_t{});
  add(channels::kSimCommand, 2.25, resume);
  std::stable_sort(events.begin(), events.end(), [](const auto& a, const auto& b) { return a.stamp_us < b.stamp_us; });
  const std::string log = (folder.path / "run.lcmlog").string();
  const auto bytes = sync::log_bytes(events);
  std::ofstream(log, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  const std::vector<RecordedCommand> commands = recorded_commands(log, 1);
  REQUIRE(commands.size() == 2);
  CHECK(commands[0].after == sync::Nanoseconds(0));
  CHECK(commands[0].command.kind == sim_command_t::PAUSE);
  // The feed rounds to its ticks of 1 ms.
  CHECK(std::abs(sync::to_seconds(commands[1].after) - 1.25) <= 0.001);
  CHECK(commands[1].command.kind == sim_command_t::RESUME);
}
