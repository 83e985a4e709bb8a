#include "thermal_node/display/controller.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace tactus::thermal;

namespace {
constexpr ControllerLimits kLimits{15, 42, 20};
constexpr double kInf = std::numeric_limits<double>::infinity();
}  // namespace

TEST_CASE("The command follows the target within the slew limit") {
  Controller controller(kLimits, 33);
  CHECK(controller.step(30, 0.02).command_degC == Approx(32.6));
  CHECK(controller.step(30, 0.02).command_degC == Approx(32.2));
  for (int i = 0; i < 20; ++i) controller.step(30, 0.02);
  CHECK(controller.step(30, 0.02).command_degC == 30);
  CHECK_FALSE(controller.step(30, 0.02).limited);
}

TEST_CASE("A target outside the skin-safe range is clamped and reported as limited") {
  Controller controller(kLimits, 33);
  Command command;
  for (int i = 0; i < 100; ++i) command = controller.step(1000, 0.02);
  CHECK(command.command_degC == 42);
  CHECK(command.limited);
  for (int i = 0; i < 200; ++i) command = controller.step(-196, 0.02);
  CHECK(command.command_degC == 15);
  CHECK(command.limited);
}

TEST_CASE("The command stays within the range and the slew limit for any target") {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    double before = 33;
    Controller controller(kLimits, before);
    for (int i = 0; i < 200; ++i) {
      const std::uint64_t bits = random();
      double wanted;
      static_assert(sizeof wanted == sizeof bits);
      std::memcpy(&wanted, &bits, sizeof wanted);  // every value of a double, infinity and NaN included
      const double dt = 0.001 * static_cast<double>(random() % 100);
      const Command command = controller.step(wanted, dt);
      REQUIRE(command.command_degC >= 15);
      REQUIRE(command.command_degC <= 42);
      REQUIRE(std::abs(command.command_degC - before) <= 20 * dt + 1e-12);
      before = command.command_degC;
    }
  }
}

TEST_CASE("A target of NaN keeps the command") {
  Controller controller(kLimits, 30);
  const Command command = controller.step(std::nan(""), 0.02);
  CHECK(command.command_degC == 30);
  CHECK_FALSE(command.limited);
}

TEST_CASE("A time step that is zero, negative or NaN keeps the command") {
  Controller controller(kLimits, 30);
  CHECK(controller.step(20, 0).command_degC == 30);
  CHECK(controller.step(20, -1).command_degC == 30);
  CHECK(controller.step(20, std::nan("")).command_degC == 30);
  CHECK(controller.step(20, kInf).command_degC == 20);
}

TEST_CASE("A narrower range applies at once") {
  Controller controller(kLimits, 40);
  controller.set_limits({20, 36, 1});
  CHECK(controller.step(40, 0.02).command_degC == 36);
}

TEST_CASE("A start outside the range is clamped") {
  CHECK(Controller(kLimits, 900).step(900, 0).command_degC == 42);
}
