#include "haptic_node/safety/acting_force.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tactus::haptic;
using Eigen::Vector3d;

namespace {

Wrench push(double n) { return {Vector3d(n, 0, 0), Vector3d(0, 2 * n, 0)}; }

}  // namespace

TEST_CASE("An immediate device has felt the command of the previous tick") {
  ForceHistory commands;
  CHECK(acting_force(commands, 0, 1, {}).force_N.isZero());
  for (int k = 0; k < 3000; ++k) commands.record(1e-3 * k, push(k));
  CHECK(acting_force(commands, 2.999, 3, {}).force_N.x() == 2999);
  CHECK(acting_force(commands, 2.999, 3, {}).torque_N_m.y() == 2 * 2999);
}

TEST_CASE("A device that applies forces with its states has felt the newest one that had arrived before each") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(0, 1);
  for (int round = 0; round < 500; ++round) {
    ForceHistory commands;
    DeviceLoop loop;
    loop.interval_s = loop.period_s = 0.02 * u(random) + 2.5e-4;
    loop.force_delay_s = 0.01 * u(random);
    const double offset_s = 0.5e-3;  // of the states between the ticks
    for (int k = 0; k < 200; ++k) commands.record(1e-3 * k, push(k));
    const int states = 1 + static_cast<int>(3 * u(random));
    const double from_s = 0.1 + offset_s;
    double expected = 0;
    for (int i = 0; i < states; ++i)
      expected += std::floor((from_s + i * loop.interval_s - loop.force_delay_s) / 1e-3 + 1e-3) / states;
    CAPTURE(loop.interval_s, loop.force_delay_s, states);
    CHECK(acting_force(commands, from_s, from_s + states * loop.interval_s, loop).force_N.x() ==
          Approx(expected).margin(1.0 / states + 1e-9));
  }
}

TEST_CASE("A command of the same instant as a state acts from the next state on") {
  ForceHistory commands;
  commands.record(0.01, push(1));
  commands.record(0.02, push(2));
  DeviceLoop loop;
  loop.interval_s = loop.period_s = 0.01;
  CHECK(acting_force(commands, 0.02, 0.03, loop).force_N.x() == 1);
  CHECK(acting_force(commands, 0.03, 0.04, loop).force_N.x() == 2);
}

TEST_CASE("A device that applies forces on arrival has felt their mean over the motion") {
  ForceHistory commands;
  DeviceLoop loop;
  loop.interval_s = loop.period_s = 0.02;
  loop.force_delay_s = 0.005;
  loop.at_once = true;
  CHECK(acting_force(commands, 0, 0.02, loop).force_N.isZero());
  for (int k = 0; k <= 100; ++k) commands.record(1e-3 * k, push(k));
  // Commands 45 to 64, each for one millisecond.
  CHECK(acting_force(commands, 0.05, 0.07, loop).force_N.x() == Approx(54.5));
  CHECK(acting_force(commands, -0.01, 0.005, loop).force_N.x() == Approx(0).margin(1e-9));
  CHECK(acting_force(commands, 0.07, 0.07, loop).force_N.isZero());
}
