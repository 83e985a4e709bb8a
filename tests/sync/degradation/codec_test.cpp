// Tests of the kinaesthetic codec: a deadband whose receiver holds the last update or continues the line through the last two.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "sync/degradation/deadband.h"
#include "sync/degradation/measured_effect.h"
#include "sync/degradation/stage_signal.h"

using namespace tactus::sync;
using Catch::Contains;
using Eigen::Vector3d;

namespace {

constexpr std::int64_t kCodecTick_ns = 1'000'000;

SimTime codec_ms(int i) { return sim_time(i * kCodecTick_ns); }

struct CodecRun {
  int packets = 0;
  double rmse = 0, relative = 0;  // largest error, relative to the value of the receiver
};

// Transmits samples of 1 kHz; the first is always sent.
CodecRun transmit(const std::vector<Vector3d>& x, const DeadbandDef& def) {
  Deadband sender(def);
  Prediction receiver(def.predictor);
  CodecRun run;
  double square = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const SimTime t = codec_ms(static_cast<int>(i));
    const Signal s{0, def.quantity, x[i]};
    if (sender.send(t, {&s, 1}, 0)) {
      receiver.add(t, x[i]);
      ++run.packets;
    }
    const Vector3d shown = receiver.at(t);
    square += (shown - x[i]).squaredNorm();
    if (shown.norm() > 0) run.relative = std::max(run.relative, (shown - x[i]).norm() / shown.norm());
  }
  run.rmse = std::sqrt(square / static_cast<double>(x.size()));
  return run;
}

std::vector<Vector3d> swell() {
  std::vector<Vector3d> x;
  for (int i = 0; i < 1000; ++i) x.emplace_back(0, 0, 1 + 0.5 * std::sin(2 * M_PI * i * 1e-3));
  return x;
}

DeadbandDef of_force(double k, Predictor predictor, double floor = 0) {
  return {.fraction = k, .quantity = Quantity::kForce, .floor = floor, .predictor = predictor};
}

OperatorChain codec_chain(const std::string& stage, const std::string& attributes) {
  return OperatorChain(parse_profile("<profile seed=\"5\"><degrade modality=\"haptic\" stage=\"" + stage + "\" " + attributes +
                                         "/></profile>",
                                     "p.xml"),
                       "haptic", {}, stage);
}

std::string codec_refusal(const std::string& attributes) {
  try {
    parse_profile("<profile>\n<degrade " + attributes + "/></profile>", "p.xml");
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

ForceSample force_of(const Vector3d& f) {
  ForceSample s;
  s.force_N = f;
  return s;
}

}  // namespace

TEST_CASE("A deadband of 10 % sends the samples that leave the band of the last sent one") {
  Deadband deadband(of_force(0.1, Predictor::kHold));
  std::set<int> sent;
  int i = 0;
  for (const double x : {1.0, 1.05, 1.09, 1.101, 1.15, 1.2, 1.22, 1.0, 0.95, 0.89}) {
    const Signal s{0, Quantity::kForce, {x, 0, 0}};
    if (deadband.send(codec_ms(i), {&s, 1}, 0)) sent.insert(i);
    ++i;
  }
  CHECK(sent == std::set<int>{0, 3, 6, 7, 9});
}

TEST_CASE("A monotone ramp from 1 to 2 needs ln 2 / ln(1 + k) packets and the first one") {
  std::vector<Vector3d> ramp;
  for (int i = 0; i <= 1'000'000; ++i) ramp.emplace_back(1 + 1e-6 * i, 0, 0);
  CHECK(transmit(ramp, of_force(0.05, Predictor::kHold)).packets == 15);
  CHECK(transmit(ramp, of_force(0.10, Predictor::kHold)).packets == 8);
  CHECK(transmit(ramp, of_force(0.20, Predictor::kHold)).packets == 4);
}

TEST_CASE("Packets and errors of a swelling force are those of both predictors") {
  struct Row {
    double k;
    int hold;
    double hold_rmse, hold_relative;
    int linear;
    double linear_rmse;
  };
  // F = 1 + 0.5 sin(2 pi t), 1 kHz, 1 s. Computed with another program.
  for (const Row& r : {Row{0.02, 101, 0.011350, 0.019994, 26, 0.010308}, Row{0.05, 42, 0.028054, 0.049989, 17, 0.026299},
                       Row{0.10, 22, 0.054168, 0.099931, 12, 0.053448}, Row{0.20, 9, 0.103599, 0.199712, 9, 0.114995}}) {
    INFO("k " << r.k);
    const CodecRun hold = transmit(swell(), of_force(r.k, Predictor::kHold));
    CHECK(hold.packets == r.hold);
    CHECK(hold.rmse == Approx(r.hold_rmse).margin(1e-6));
    CHECK(hold.relative == Approx(r.hold_relative).margin(1e-6));
    const CodecRun linear = transmit(swell(), of_force(r.k, Predictor::kLinear));
    CHECK(linear.packets == r.linear);
    CHECK(linear.rmse == Approx(r.linear_rmse).margin(1e-6));
  }
}

TEST_CASE("With either predictor the error is at most k of the value of the receiver, for random forces in three axes") {
  std::mt19937 random(8);
  std::normal_distribution<double> step(0, 0.02);
  std::uniform_real_distribution<double> fraction(0, 0.4);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Vector3d> x{{1, -0.5, 0.2}};
    Vector3d speed(0, 0, 0);
    for (int i = 1; i < 2000; ++i) {
      for (int c = 0; c < 3; ++c) speed[c] += 0.1 * step(random);
      x.push_back(x.back() + 0.01 * speed + (trial % 2 ? Vector3d(step(random), step(random), step(random)) : Vector3d::Zero()));
    }
    const double k = fraction(random);
    for (const Predictor p : {Predictor::kHold, Predictor::kLinear}) {
      const CodecRun run = transmit(x, of_force(k, p));
      INFO("trial " << trial << ", k " << k);
      CHECK(run.relative <= k * (1 + 1e-9));
      CHECK(run.packets >= 1);
    }
  }
}

TEST_CASE("A wider band never costs a smooth signal more packets, and a line needs fewer than a held value at 5 %") {
  int before[2] = {1001, 1001};
  for (const double k : {0.0, 0.02, 0.05, 0.1, 0.2, 0.4})
    for (const Predictor p : {Predictor::kHold, Predictor::kLinear}) {
      int& last = before[static_cast<int>(p)];
      const int packets = transmit(swell(), of_force(k, p)).packets;
      CHECK(packets <= last);
      last = packets;
    }
  CHECK(transmit(swell(), of_force(0.05, Predictor::kLinear)).packets < transmit(swell(), of_force(0.05, Predictor::kHold)).packets / 2);
}

TEST_CASE("A line ends at the reach of its two updates, so that the loss of an update does not let the value run away") {
  Prediction line(Predictor::kLinear);
  CHECK(line.empty());
  CHECK(line.at(codec_ms(5)) == Vector3d::Zero());
  line.add(codec_ms(0), {0, 0, 0});
  line.add(codec_ms(1), {1, 0, 0});
  CHECK(line.at(codec_ms(11)).x() == Approx(11));
  CHECK(line.at(codec_ms(5000)).x() == Approx(1 + Prediction::kReach));
  line.add(codec_ms(1001), {2, 0, 0});
  CHECK(line.at(codec_ms(9000)).x() == Approx(2 + Prediction::kMaxReach_s));
  CHECK(line.integral(codec_ms(2001)).x() == Approx(2.5));  // from 2 to 3 within a second
  line.add(codec_ms(900), {3, 0, 0});                       // not later: a new line
  CHECK(line.at(codec_ms(1000)).x() == 3);
}

TEST_CASE("An update is sent again after the time of resend") {
  DeadbandDef def = of_force(0.1, Predictor::kHold);
  def.resend_s = 0.05;
  CHECK(transmit(std::vector<Vector3d>(1000, Vector3d(1, 0, 0)), def).packets == 20);
}

TEST_CASE("A stage with predict=linear delivers the line of the receiver, and counts the packets") {
  for (const char* stage : {"force", "percept"}) {
    OperatorChain chain = codec_chain(stage, "deadband=\"5% force predict=linear\"");
    StageSignal signal;
    Decisions decisions;
    double square = 0;
    const auto x = swell();
    for (int i = 0; i < 1000; ++i) {
      const ForceSample& shown = signal.step(host_time(i * kCodecTick_ns), codec_ms(i), force_of(x[static_cast<std::size_t>(i)]), chain, &decisions);
      square += (shown.force_N - x[static_cast<std::size_t>(i)]).squaredNorm();
    }
    CHECK(std::sqrt(square / 1000) == Approx(0.026299).margin(1e-6));
    MeasuredEffect effect;
    for (const DecisionRecord& d : decisions) effect.add(d, Nanoseconds(0));
    CHECK(effect.snapshots().sent() == 17);
    CHECK_THAT(effect.text(), Contains("17 of 1000 sent"));
  }
}

TEST_CASE("A delayed codec delivers the same values later, with and without a line") {
  for (const char* predictor : {"hold", "linear"}) {
    const std::string band = "deadband=\"5% force predict=" + std::string(predictor) + "\"";
    OperatorChain now = codec_chain("force", band), late = codec_chain("force", band + " delay=\"30ms\"");
    StageSignal a, b;
    std::vector<Vector3d> undelayed;
    const auto x = swell();
    for (int i = 0; i < 1000; ++i) {
      const ForceSample s = force_of(x[static_cast<std::size_t>(i)]);
      undelayed.push_back(a.step(host_time(i * kCodecTick_ns), codec_ms(i), s, now).force_N);
      const Vector3d shown = b.step(host_time(i * kCodecTick_ns), codec_ms(i), s, late).force_N;
      REQUIRE((shown - (i < 30 ? Vector3d(Vector3d::Zero()) : undelayed[static_cast<std::size_t>(i - 30)])).norm() < 1e-12);
    }
  }
}

TEST_CASE("A deadband of 0 % with either predictor changes nothing, to the bit") {
  for (const char* predictor : {"hold", "linear"}) {
    OperatorChain chain = codec_chain("force", "deadband=\"0% force predict=" + std::string(predictor) + "\"");
    StageSignal signal;
    std::mt19937 random(4);
    std::normal_distribution<double> noise(0, 1);
    for (int i = 0; i < 2000; ++i) {
      ForceSample s = force_of({noise(random), noise(random), i % 7 ? 1.0 : noise(random)});
      REQUIRE(signal.step(host_time(i * kCodecTick_ns), codec_ms(i), s, chain) == s);
    }
  }
}

TEST_CASE("The energy of a suppressed packet is that of the last sent one") {
  for (const char* predictor : {"hold", "linear"}) {
    OperatorChain chain = codec_chain("force", "deadband=\"10% force predict=" + std::string(predictor) + "\"");
    StageSignal signal;
    Decisions decisions;
    const auto x = swell();
    double sent_J = 0;
    int repeated = 0;
    for (int i = 0; i < 1000; ++i) {
      ForceSample s = force_of(x[static_cast<std::size_t>(i)]);
      s.energy_J = 0.001 * i;
      const double shown_J = signal.step(host_time(i * kCodecTick_ns), codec_ms(i), s, chain, &decisions).energy_J;
      if (decisions.back().decision.dropped())
        ++repeated;
      else
        sent_J = s.energy_J;
      REQUIRE(shown_J == sent_J);
    }
    CHECK(repeated > 900);
  }
}

TEST_CASE("At a stage quantise, gain and low-pass act before the deadband, as in the order of the operators") {
  // Steps of 0.5 N in a band of 0.4 N: each step is sent, and no value between two steps is.
  OperatorChain chain = codec_chain("force", "quantise=\"0.5N\" deadband=\"0% force floor=0.4N\"");
  StageSignal signal;
  Decisions decisions;
  for (int i = 0; i <= 1000; ++i)
    signal.step(host_time(i * kCodecTick_ns), codec_ms(i), force_of({0.002 * i, 0, 0}), chain, &decisions);
  int sent = 0;
  for (const DecisionRecord& d : decisions) sent += !d.decision.dropped();
  CHECK(sent == 5);
  // A low-pass of the same rule sees each sample, also one that a rate drops.
  OperatorChain slow = codec_chain("force", "lowpass=\"10Hz\" rate=\"100Hz\"");
  StageSignal filtered;
  Vector3d shown;
  for (int i = 0; i <= 50; ++i)
    shown = filtered.step(host_time(i * kCodecTick_ns), codec_ms(i), force_of({i > 0 ? 1.0 : 0.0, 0, 0}), slow).force_N;
  CHECK(shown.x() == Approx(1 - std::exp(-2 * M_PI * 10 * 0.050)).epsilon(1e-9));
}

TEST_CASE("Under a new profile, and after a restart of the world, the line of the receiver begins without earlier updates") {
  for (const bool restarts : {false, true}) {
    const std::string band = "deadband=\"5% force predict=linear\"";
    OperatorChain before = codec_chain("force", band), after = codec_chain("force", band);
    StageSignal signal;
    for (int i = 0; i < 1500; ++i) signal.step(host_time(i * kCodecTick_ns), codec_ms(i), force_of({0, 0, 5 - 1e-6 * i}), before);
    // The force changes once, so that one update is sent.
    for (int i = 1500; i < 4000; ++i) {
      const ForceSample& shown = signal.step(host_time(i * kCodecTick_ns), codec_ms(restarts ? i - 1500 : i), force_of({0, 0, 1}), restarts ? before : after);
      REQUIRE(shown.force_N.z() == Approx(1).margin(0.05));
    }
  }
}

TEST_CASE("At a stage an adaptive deadband widens with the speed of the hand") {
  int packets[2] = {0, 0};
  for (int fast = 0; fast < 2; ++fast) {
    OperatorChain chain = codec_chain("force", "deadband=\"5% force adaptive=0.5s/m\"");
    StageSignal signal;
    Decisions decisions;
    const auto x = swell();
    for (int i = 0; i < 1000; ++i) {
      ForceSample s = force_of(x[static_cast<std::size_t>(i)]);
      s.speed_m_s = fast ? 0.3 : 0;
      signal.step(host_time(i * kCodecTick_ns), codec_ms(i), s, chain, &decisions);
    }
    for (const DecisionRecord& d : decisions) packets[fast] += !d.decision.dropped();
  }
  CHECK(packets[0] == 42);
  CHECK(packets[1] == 9);  // as with 20 %
}

TEST_CASE("At a stage a deadband that would never send the end of a force or a motion is refused") {
  for (const char* rule : {"stage=\"force\" deadband=\"100% force\"", "stage=\"percept\" deadband=\"300% force\"", "stage=\"action\" deadband=\"100% velocity\""})
    CHECK_THAT(codec_refusal(std::string("modality=\"haptic\" ") + rule), Contains("p.xml:2: ") && Contains("give less, or resend="));
  CHECK(codec_refusal("modality=\"haptic\" stage=\"force\" deadband=\"100% force resend=50ms\"").empty());
  CHECK(codec_refusal("modality=\"haptic\" deadband=\"100% velocity\"").empty());
}

TEST_CASE("predict and passivity are refused where no receiver predicts or no force is displayed") {
  CHECK_THAT(codec_refusal("modality=\"haptic\" deadband=\"10% velocity predict=linear\""), Contains("p.xml:2: ") && Contains("needs a receiver that predicts"));
  CHECK_THAT(codec_refusal("modality=\"audio\" deadband=\"10% force predict=linear\""), Contains("needs a receiver that predicts"));
  CHECK_THAT(codec_refusal("modality=\"haptic\" stage=\"force\" deadband=\"10% force predict=cubic\""), Contains("choose hold or linear"));
  CHECK_THAT(codec_refusal("modality=\"haptic\" stage=\"force\" deadband=\"10% force predict=linear lowpass=20Hz\""), Contains("remove lowpass= here"));
  CHECK_THAT(codec_refusal("modality=\"haptic\" stage=\"action\" deadband=\"10% force\""), Contains("transmits a motion"));
  CHECK_THAT(codec_refusal("modality=\"haptic\" stage=\"percept\" passivity=\"tdpa\""), Contains("has no passivity"));
  CHECK_THAT(codec_refusal("modality=\"haptic\" stage=\"action\" passivity=\"tdpa\""), Contains("has no passivity"));
  CHECK_THAT(codec_refusal("modality=\"haptic\" passivity=\"tdpa\""), Contains("give stage=\"force\""));
  CHECK_THAT(codec_refusal("modality=\"haptic\" stage=\"force\" passivity=\"iss\""), Contains("choose none or tdpa"));
  CHECK(codec_refusal("modality=\"haptic\" stage=\"force\" deadband=\"10% force predict=linear resend=50ms\" delay=\"20ms\" passivity=\"tdpa\"").empty());
  CHECK(codec_refusal("modality=\"haptic\" stage=\"action\" deadband=\"10% position predict=linear floor=1mm\"").empty());
}
