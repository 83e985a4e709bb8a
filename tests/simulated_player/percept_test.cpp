// Tests of the stage `percept`: the arm moves under the force of the device, for any percept.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "scripts/simulated_player/arm.h"
#include "sync/degradation/stage_signal.h"

using namespace tactus;
using namespace tactus::simulated_player;
using Eigen::Vector3d;

namespace {

sync::OperatorChain percept_operators(const std::string& attributes) {
  if (attributes.empty()) return {};
  return sync::OperatorChain(
      sync::parse_profile("<profile><degrade modality=\"haptic\" stage=\"percept\" " + attributes + "/></profile>", "p.xml"), "haptic",
      {}, "percept");
}

struct PerceptRun {
  std::vector<Vector3d> arm, ball, perceived;
};

// A scripted arm pushes a ball that slides with friction, through a spring at the hand: one loop of arm and world.
PerceptRun scripted_push(const std::string& attributes) {
  sync::OperatorChain operators = percept_operators(attributes);
  sync::StageSignal touch;
  Arm arm({}, Vector3d(0, 0, 0), 5);
  Vector3d ball(0.05, 0, 0), speed(0, 0, 0);
  PerceptRun run;
  for (int tick = 0; tick < 3000; ++tick) {
    const double t = 1e-3 * tick;
    const double depth = std::max(0.0, 0.02 - (ball.x() - arm.position_m().x()));
    const Vector3d force(-500 * depth, 0, 0);
    speed += 1e-3 * (-force / 0.1 - 3 * speed);
    ball += 1e-3 * speed;
    sync::ForceSample sample;
    sample.force_N = force;
    const std::int64_t ns = tick * 1'000'000LL;
    run.perceived.push_back(touch.step(sync::host_time(ns), sync::sim_time(ns), sample, operators).force_N);
    arm.step(Vector3d(0.1 * t + 0.01 * std::sin(9 * t), 0.02 * std::sin(5 * t), 0), force, 1e-3);
    run.arm.push_back(arm.position_m());
    run.ball.push_back(ball);
  }
  return run;
}

}  // namespace

TEST_CASE("With a scripted arm, perception operators of any severity leave arm and world identical to the bit") {
  const PerceptRun clear = scripted_push("");
  double most = 0;
  for (const Vector3d& f : clear.perceived) most = std::max(most, f.norm());
  REQUIRE(most > 0.2);
  std::mt19937 random(21);
  const auto draw = [&](double low, double high) { return std::to_string(std::uniform_real_distribution<double>(low, high)(random)); };
  std::vector<std::string> profiles{"off=\"true\"", "freeze=\"hold\"", "loss=\"100%\"", "gain=\"-1000\"", "delay=\"2s\""};
  for (int i = 0; i < 15; ++i)
    profiles.push_back("delay=\"" + draw(30, 1500) + "ms\" jitter=\"" + draw(1, 9) + "ms normal\" loss=\"" + draw(0, 90) +
                       "%\" rate=\"" + draw(1, 300) + "Hz\" quantise=\"" + draw(0.1, 5) + "N\" gain=\"" + draw(-3, 3) +
                       "\" lowpass=\"" + draw(0.5, 100) + "Hz\"");
  for (const std::string& attributes : profiles) {
    INFO(attributes);
    const PerceptRun degraded = scripted_push(attributes);
    REQUIRE(degraded.arm == clear.arm);
    REQUIRE(degraded.ball == clear.ball);
    CHECK(degraded.perceived != clear.perceived);
  }
}

TEST_CASE("A percept that is 0 ms late equals no operator to the bit") {
  CHECK(scripted_push("delay=\"0\"").perceived == scripted_push("").perceived);
}
