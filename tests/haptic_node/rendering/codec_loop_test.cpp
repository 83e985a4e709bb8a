// Tests of the kinaesthetic codec in the loop of touch: a hand in closed loop with a wall or a body, whose force is transmitted
// with a deadband and a delay and controlled by time-domain passivity.
#include <catch2/catch.hpp>
#include <array>
#include <cstdlib>
#include <random>

#include "haptic_node/devices/virtual_hand.h"
#include "haptic_node/safety/tdpa.h"
#include "tests/haptic_node/support/episode_world.h"
#include "tests/haptic_node/support/world.h"

using namespace tactus;
using namespace tactus::haptic;
using namespace tactus::haptic::test;

namespace {

sync::OperatorChain codec_operators(const std::string& attributes) {
  return sync::OperatorChain(
      sync::parse_profile("<profile seed=\"3\"><degrade modality=\"haptic\" stage=\"force\" " + attributes + "/></profile>", "p.xml"),
      "haptic", {}, "force");
}

struct CodecLoop {
  // Largest energy that the hand received beyond that of the packets that had arrived (promised), from the begin of the control on,
  // apart from that below the least speed of the controller (slow); sum of the energy that the hand received because it moved further
  // along a force than in the tick before (unexpected); and energy beyond the most work of the computed force (injected).
  double beyond_promise_J = 0, slow_J = 0, unexpected_J = 0, injected_J = 0, received_J = 0, peak_N = 0, rise_N = 0;
  std::vector<double> force_N;
};

CodecLoop run_codec(const std::string& attributes, int delay_ms, const HandImpedance& impedance, double stiffness_N_m,
                    const Settings& s, double mass_kg = 0, int controls_from_ms = 0) {
  VirtualHand hand(MonotoneCubic({0, 0.3, 1.2, 1.4, 2.2, 2.5, 4}, {place(0.02), place(-0.004), place(-0.004), place(0.012),
                                                                   place(-0.006), place(0.02), place(0.02)},
                                 MonotoneCubic::Ends::kRest),
                   false, impedance);
  sync::OperatorChain operators = codec_operators(attributes);
  Bench bench(s);
  EpisodeWorld world{.mass_kg = mass_kg, .stiffness_N_m = stiffness_N_m};
  hand.begin(host_ms(0));
  CodecLoop run;
  Vector3d last = hand.read(host_ms(0)).position, force = Vector3d::Zero();
  double moved_before = 0, computed_N = 0, displayed_J = 0, computed_J = 0, max_J = 0, apart_s = 0;
  double released_J = 0, released_before_J = 0;  // of the computed force; until the control begins
  std::vector<double> promised_J;  // in the packet of each tick: released, and expected in the coming tick
  for (int ms = 0; ms < 4000; ++ms) {
    if (ms == controls_from_ms) {
      run.received_J = run.slow_J = run.unexpected_J = run.beyond_promise_J = 0;
      released_before_J = released_J;
    }
    const DeviceState state = hand.read(host_ms(ms));
    const double moved = state.position.z() - last.z();
    last = state.position;
    displayed_J += force.z() * moved;
    run.unexpected_J += std::max(0.0, force.z() * moved) - std::min(std::max(0.0, force.z() * moved), std::max(0.0, force.z() * moved_before));
    moved_before = moved;
    computed_J += computed_N * moved;
    max_J = std::max(max_J, computed_J);
    run.received_J += std::max(0.0, force.z() * moved);
    if (std::abs(moved) < TimeDomainPassivity::kMinSpeed_m_s * kDt) run.slow_J += std::max(0.0, force.z() * moved);
    released_J += std::max(0.0, computed_N * moved);
    run.injected_J = std::max(run.injected_J, displayed_J - max_J);
    const int packet = ms - 1 - delay_ms;  // the newest at the tick before, whose force has acted
    const double promise_J = packet < 0 ? 0 : promised_J[static_cast<std::size_t>(packet)];
    run.beyond_promise_J = std::max(run.beyond_promise_J, run.received_J - run.slow_J - std::max(0.0, promise_J - released_before_J));
    const touch_model_t m = world.model_at(ms);
    TickInput in;
    in.force_stage = &operators;
    const TickOutput& out = bench.tick(ms, state.position, &m, {}, in);
    run.rise_N = std::max(run.rise_N, beyond_slew_N(out.force_N, force, s.slew_limit_N_s * 1e-3));
    force = out.force_N;
    run.force_N.push_back(force.z());
    run.peak_N = std::max(run.peak_N, force.norm());
    hand.write(force);
    computed_N = 0;
    for (const auto& c : out.state.constraints) computed_N += c.force_N.z;
    promised_J.push_back(std::max(promised_J.empty() ? 0 : promised_J.back(), released_J + std::max(0.0, computed_N * moved)));
    world.step(-computed_N);
    apart_s = force.isZero(0) && computed_N == 0 ? apart_s + kDt : 0;
    if (apart_s > 0.2) displayed_J = computed_J = max_J = 0;
  }
  return run;
}

}  // namespace

TEST_CASE("With TDPA a delayed force gives the hand at most the energy that its packets promise") {
  std::array<double, 2> max_mJ{};  // beyond the promise: with TDPA and without
  for (int trial = 0; trial < 60; ++trial) {
    std::mt19937 random(static_cast<unsigned>(31 + trial));
    const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
    Settings s;
    s.device_damping_Ns_m = draw(0.5, 20);
    s.device_mass_kg = draw(0.05, 0.3);
    const HandImpedance hand{s.device_mass_kg * draw(1, 4), s.device_damping_Ns_m * draw(1, 10), draw(50, 800)};
    const int delay_ms = static_cast<int>(draw(1, 120));
    const std::string band = trial % 3 == 0 ? "" : trial % 3 == 1 ? " deadband=\"10% force\"" : " deadband=\"10% force predict=linear\"";
    const std::string operators = "delay=\"" + std::to_string(delay_ms) + "ms\"" + band;
    const double stiffness_N_m = draw(200, 2000), mass_kg = trial % 4 == 3 ? draw(0.05, 1) : 0;
    INFO(operators << ", hand " << hand.mass_kg << " kg " << hand.damping_N_s_m << " N s/m " << hand.stiffness_N_m << " N/m, wall "
                   << stiffness_N_m << " N/m, body " << mass_kg << " kg");
    const CodecLoop with = run_codec(operators + " passivity=\"tdpa\"", delay_ms, hand, stiffness_N_m, s, mass_kg);
    // The controller expects the motion of the last tick: a hand that reverses or accelerates within a tick receives more.
    CHECK(with.beyond_promise_J <= with.unexpected_J + 1e-9);
    CHECK(with.beyond_promise_J < 0.001);
    if (s.device_damping_Ns_m < 2) CHECK(with.injected_J < s.generated_limit_J);
    CHECK(with.peak_N <= s.force_limit_N + 1e-9);
    CHECK(with.rise_N < 1e-9);
    max_mJ[0] = std::max(max_mJ[0], 1e3 * with.beyond_promise_J);
    max_mJ[1] = std::max(max_mJ[1], 1e3 * run_codec(operators, delay_ms, hand, stiffness_N_m, s, mass_kg).beyond_promise_J);
  }
  CHECK(max_mJ[0] < max_mJ[1] / 20);
  if (std::getenv("TACTUS_PRINT")) WARN("largest energy beyond the promise: " << max_mJ[0] << " mJ with TDPA, " << max_mJ[1] << " mJ without");
}

TEST_CASE("When TDPA begins again, packets from before promise nothing") {
  Settings s;
  s.generated_limit_J = 0.01;  // so that this controller acts before that of the display
  const auto rule = [](const char* when) { return std::string("passivity=\"tdpa\" ") + when; };
  // Controlled until the hand leaves the wall the first time, and again while it leaves it the second time.
  const std::string operators = "delay=\"60ms\"/><degrade modality=\"haptic\" stage=\"force\" " + rule("until=\"2.2s\"") +
                                "/><degrade modality=\"haptic\" stage=\"force\" " + rule("from=\"2.25s\"");
  const CodecLoop run = run_codec(operators, 60, {0.2, 6, 300}, 1500, s, 0, 2250);
  CHECK(run.received_J > 1e-4);
  CHECK(run.beyond_promise_J <= run.unexpected_J + 1e-9);
}

TEST_CASE("TDPA changes no force that is displayed as computed, to the bit") {
  Settings s;
  const HandImpedance arm{1, 25, 300};
  for (const double mass_kg : {0.0, 0.3}) {
    const auto reference = run_codec("delay=\"0\"", 0, arm, 1000, s, mass_kg).force_N;
    CHECK(run_codec("passivity=\"tdpa\"", 0, arm, 1000, s, mass_kg).force_N == reference);
    CHECK(run_codec("passivity=\"none\"", 0, arm, 1000, s, mass_kg).force_N == reference);
    CHECK(run_codec("passivity=\"tdpa\" deadband=\"0% force predict=linear\"", 0, arm, 1000, s, mass_kg).force_N == reference);
  }
}

TEST_CASE("A wall with a codec of 5 % supports the hand as before, within the share of the hand in the stiffness") {
  Settings s;
  const HandImpedance arm{1, 25, 300};
  const CodecLoop plain = run_codec("delay=\"0\"", 0, arm, 1000, s);
  for (const char* codec : {"deadband=\"5% force\"", "deadband=\"5% force predict=linear\""}) {
    const CodecLoop coded = run_codec(codec, 0, arm, 1000, s);
    // Pressed at rest from 0.9 to 1.2 s. A share d of too much force moves the hand (300 N/m) on the wall (1000 N/m), so that the force
    // changes by d 300 / 1300 only.
    double sum_N = 0, plain_N = 0;
    for (std::size_t ms = 900; ms < 1200; ++ms) sum_N += coded.force_N[ms], plain_N += plain.force_N[ms];
    CHECK(std::abs(sum_N - plain_N) <= 0.05 * 300 / 1300 * plain_N);
  }
}
