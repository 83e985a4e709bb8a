// Tests of the stages of touch: their names in a profile, and the signal of a stage.
#include "sync/degradation/stage_signal.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "sync/degradation/known_modalities.h"

using namespace tactus::sync;
using Catch::Contains;
using Eigen::Vector3d;

namespace {

constexpr std::int64_t kTick_ns = 1'000'000;

OperatorChain stage_chain(const std::string& stage, const std::string& attributes) {
  return OperatorChain(parse_profile("<profile seed=\"5\"><degrade modality=\"haptic\" stage=\"" + stage + "\" " + attributes +
                                         "/></profile>",
                                     "p.xml"),
                       "haptic", {}, stage);
}

std::string stage_refusal(const std::string& modality, const std::string& attributes) {
  try {
    parse_profile("<profile>\n<degrade modality=\"" + modality + "\" " + attributes + "/></profile>", "p.xml");
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

ForceSample sample_of(int tick) {
  ForceSample s;
  s.force_N = {std::sin(0.1 * tick), 0.5 * std::cos(0.07 * tick), 0.01 * tick};
  s.torque_N_m = {0.001 * tick, 0, -0.002 * tick};
  s.transient_N = 0.25 * s.force_N;
  return s;
}

// Passes `count` samples through a stage, one each millisecond; returns the delivered ones.
std::vector<ForceSample> delivered(OperatorChain chain, int count) {
  StageSignal signal;
  std::vector<ForceSample> out;
  for (int tick = 0; tick < count; ++tick)
    out.push_back(signal.step(host_time(7 + tick * kTick_ns), sim_time(tick * kTick_ns), sample_of(tick), chain));
  return out;
}

}  // namespace

TEST_CASE("A rule acts at the stage that it names only, and without a name at the stage model") {
  const Profile p = parse_profile(
      "<profile><degrade modality=\"haptic\" delay=\"10ms\"/><degrade modality=\"haptic\" stage=\"model\" loss=\"5%\"/>"
      "<degrade modality=\"haptic\" stage=\"force\" delay=\"20ms\"/><degrade modality=\"haptic\" stage=\"percept\" off=\"true\"/>"
      "<degrade modality=\"haptic\" stage=\"action\" delay=\"30ms\"/></profile>",
      "p.xml");
  REQUIRE(p.rules.size() == 5);
  CHECK((p.rules[0].stage.empty() && p.rules[1].stage.empty()));
  CHECK(OperatorChain(p, "haptic", {}).presentation_delay({}) == std::chrono::milliseconds(10));
  CHECK(OperatorChain(p, "haptic", {}, "force").constant_delay({}) == std::chrono::milliseconds(20));
  CHECK(OperatorChain(p, "haptic", {}, "action").constant_delay({}) == std::chrono::milliseconds(30));
  CHECK(OperatorChain(p, "haptic", {}, "percept").cuts_off({}));
  CHECK_FALSE(OperatorChain(p, "haptic", {}).cuts_off({}));
}

TEST_CASE("Touch declares the stages model, action, force and percept") {
  std::set<std::string> names;
  for (const StageDef& s : known_modality("haptic")->stages) {
    names.insert(s.name);
    CHECK_FALSE(s.meaning.empty());
  }
  CHECK(names == std::set<std::string>{"model", "action", "force", "percept"});
  CHECK(modality_with_stage("action") == known_modality("haptic"));
  CHECK(modality_with_stage("nowhere") == nullptr);
  CHECK(modalities_with_stages() == "haptic");
}

TEST_CASE("A stage that does not exist, or an operator that a stage does not have, is refused with its line") {
  CHECK_THAT(stage_refusal("audio", "stage=\"force\" delay=\"5ms\""), Contains("p.xml:2: ") && Contains("has no stages"));
  CHECK_THAT(stage_refusal("wind", "stage=\"force\" delay=\"5ms\""), Contains("has no stages"));
  CHECK_THAT(stage_refusal("haptic", "stage=\"feel\" delay=\"5ms\""), Contains("choose from model, action, force, percept"));
  CHECK_THAT(stage_refusal("haptic", "stage=\"force\""), Contains("does nothing"));
  for (const char* wrong : {"wire_loss=\"5%\"", "material=\"steel\"", "bodies=\"a b\"", "bias=\"1N\"", "skew=\"5ppm\"",
                            "duplicate=\"5%\"", "force_step=\"1N\"", "reorder=\"5%\""})
    for (const char* stage : {"force", "percept", "action"})
      CHECK_THAT(stage_refusal("haptic", "off=\"true\" stage=\"" + std::string(stage) + "\" " + wrong), Contains("the stage "));
  CHECK_THAT(stage_refusal("haptic", "stage=\"action\" gain=\"0.5 force\""), Contains("has no gain"));
  CHECK_THAT(stage_refusal("haptic", "stage=\"force\" gain=\"0.5 velocity\""), Contains("is a force"));
  CHECK_THAT(stage_refusal("haptic", "stage=\"force\" deadband=\"10%\""), Contains("is a force"));
  CHECK_THAT(stage_refusal("haptic", "stage=\"force\" delay=\"900ms\" jitter=\"200ms uniform\""), Contains("1000ms"));
  CHECK_THAT(stage_refusal("haptic", "stage=\"force\" delay=\"9ms\" jitter=\"2ms uniform order=free\""), Contains("order=free"));
  CHECK(stage_refusal("haptic", "stage=\"force\" quantise=\"0.5N\" lowpass=\"20Hz\" deadband=\"10% force\"").empty());
}

TEST_CASE("A signal with a delay of 0, or with neutral operators, is delivered to the bit in the same tick") {
  for (const char* neutral : {"delay=\"0\"", "delay=\"0 network\"", "gain=\"1\"", "loss=\"0%\"", "delay=\"40ms\" from=\"5s\""}) {
    const auto out = delivered(stage_chain("force", neutral), 300);
    for (int tick = 0; tick < 300; ++tick) REQUIRE(out[static_cast<std::size_t>(tick)] == sample_of(tick));
  }
  CHECK(delivered(OperatorChain(), 1).front() == sample_of(0));
}

TEST_CASE("A delayed signal is the same signal later, with either kind of delay") {
  for (const char* kind : {"", " network"}) {
    const auto out = delivered(stage_chain("force", "delay=\"40ms" + std::string(kind) + "\""), 400);
    for (int tick = 0; tick < 400; ++tick)
      REQUIRE(out[static_cast<std::size_t>(tick)] == (tick < 40 ? ForceSample{} : sample_of(tick - 40)));
  }
}

TEST_CASE("The delivered sample never becomes older under a jitter, and its mean delay is that of the profile") {
  const auto out = delivered(stage_chain("force", "delay=\"30ms\" jitter=\"9ms normal\""), 6000);
  double last = -1, sum = 0;
  for (int tick = 200; tick < 6000; ++tick) {
    const double from = out[static_cast<std::size_t>(tick)].force_N.z() / 0.01;  // tick of the sample
    REQUIRE(from >= last - 1e-9);
    last = from;
    sum += tick - from;
  }
  // The newest of the samples that are due: its delay is below the mean of 30 ms, and above the least delay.
  CHECK(sum / 5800 > 5);
  CHECK(sum / 5800 < 30);
}

TEST_CASE("A rate holds the samples of a signal, a loss holds the last one or conceals it by zero") {
  const auto held = delivered(stage_chain("percept", "rate=\"50Hz\""), 200);
  std::set<double> levels;
  for (const ForceSample& s : held) levels.insert(s.force_N.z());
  CHECK(levels.size() == 10);
  int same = 0, zero = 0;
  const auto lost = delivered(stage_chain("percept", "loss=\"30%\""), 4000);
  const auto concealed = delivered(stage_chain("percept", "loss=\"30%\" conceal=\"zero\""), 4000);
  for (std::size_t tick = 1; tick < 4000; ++tick) {
    same += lost[tick] == lost[tick - 1];
    zero += concealed[tick] == ForceSample{};
  }
  // Binomial: 1200 expected, standard deviation 29.
  CHECK(std::abs(same - 1200) < 5 * 29);
  CHECK(std::abs(zero - 1200) < 5 * 29);
}

TEST_CASE("A signal that is off is zero at once, and a frozen one keeps its last sample") {
  const auto off = delivered(stage_chain("force", "off=\"true\" from=\"0.1s\""), 200);
  CHECK(off[99] == sample_of(99));
  CHECK(off[100] == ForceSample{});
  const auto frozen = delivered(stage_chain("force", "freeze=\"hold\" from=\"0.1s\""), 200);
  CHECK(frozen[199] == sample_of(99));
  const auto zero = delivered(stage_chain("force", "freeze=\"zero\" from=\"0.1s\""), 200);
  CHECK(zero[199] == ForceSample{});
}

TEST_CASE("Concealment by zero is as late as the samples that it replaces") {
  const auto out = delivered(stage_chain("force", "delay=\"20ms\" freeze=\"zero\" from=\"0.1s\""), 200);
  CHECK(out[99] == sample_of(99));
  CHECK(out[119] == sample_of(99));
  CHECK(out[120] == ForceSample{});
}

TEST_CASE("Quantising a force keeps its direction, and gain and low-pass act on all of its parts") {
  OperatorChain steps = stage_chain("force", "quantise=\"0.5N\""), half = stage_chain("force", "gain=\"0.5\"");
  std::mt19937 random(3);
  std::uniform_real_distribution<double> axis(-3, 3);
  for (int i = 0; i < 200; ++i) {
    ForceSample s;
    s.force_N = {axis(random), axis(random), axis(random)};
    s.torque_N_m = {axis(random), 0, 0};
    s.transient_N = 0.5 * s.force_N;
    ForceSample q = s, g = s;
    steps.degrade_force(q, {});
    CHECK(q.force_N.norm() == Approx(std::round(s.force_N.norm() / 0.5) * 0.5).margin(1e-12));
    CHECK(q.force_N.cross(s.force_N).norm() < 1e-12);
    CHECK((q.transient_N - 0.5 * q.force_N).norm() < 1e-12);
    CHECK(q.torque_N_m == s.torque_N_m);
    half.degrade_force(g, {});
    CHECK((g.force_N == 0.5 * s.force_N && g.torque_N_m == 0.5 * s.torque_N_m && g.transient_N == 0.5 * s.transient_N));
  }
  // First order: 1 - exp(-2 pi f t) of a step.
  OperatorChain slow = stage_chain("force", "lowpass=\"10Hz\"");
  StageSignal signal;
  ForceSample s, out;
  for (int tick = 0; tick <= 50; ++tick) {
    s.force_N.x() = tick > 0 ? 1 : 0;
    out = signal.step(host_time(tick * kTick_ns), sim_time(tick * kTick_ns), s, slow);
  }
  CHECK(out.force_N.x() == Approx(1 - std::exp(-2 * M_PI * 10 * 0.050)).epsilon(1e-9));
}

TEST_CASE("The decisions of a stage are recorded with the delay that they cause") {
  OperatorChain chain = stage_chain("force", "delay=\"25ms\" loss=\"20%\"");
  StageSignal signal;
  Decisions decisions;
  for (int tick = 0; tick < 1000; ++tick)
    signal.step(host_time(tick * kTick_ns), sim_time(tick * kTick_ns), sample_of(tick), chain, &decisions);
  REQUIRE(decisions.size() == 1000);
  int lost = 0;
  std::set<std::uint64_t> keys;
  for (const DecisionRecord& d : decisions) {
    lost += d.decision.dropped();
    keys.insert(d.key);
    if (!d.decision.dropped()) CHECK(d.decision.release - d.arrival == std::chrono::milliseconds(25));
  }
  CHECK(keys.size() == 1000);
  CHECK(std::abs(lost - 200) < 5 * 13);
}

TEST_CASE("While the world stands still each tick of a signal is drawn for separately") {
  OperatorChain chain = stage_chain("percept", "loss=\"50%\"");
  StageSignal signal;
  Decisions decisions;
  for (int tick = 0; tick < 400; ++tick) signal.step(host_time(tick * kTick_ns), sim_time(9), sample_of(tick), chain, &decisions);
  int lost = 0;
  for (const DecisionRecord& d : decisions) lost += d.decision.dropped();
  CHECK(std::abs(lost - 200) < 50);
}

TEST_CASE("A signal with more waiting samples than fit delivers the newer ones") {
  OperatorChain chain = stage_chain("force", "delay=\"1s\"");
  StageSignal signal;
  for (int tick = 0; tick < 20'000; ++tick)
    signal.step(host_time(tick * 100'000), sim_time(tick * 100'000), sample_of(tick), chain);
  // At 10 kHz a second holds 10,000 samples: only 4,096 wait, so nothing is due within their 0.41 s.
  CHECK(signal.delivered() == ForceSample{});
}
