#include "thermal_node/display/plate_controller.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace tactus::thermal;

namespace {

constexpr double kDt = 0.001;

struct Plate {
  PeltierPlant plant;
  PlateLimits limits;
  PlateController controller{plant, limits};
  PeltierState state{33, 23};
  PlateDrive drive;

  void follow(double wanted_degC, double load_W, double seconds, double known_load_W) {
    for (int i = 0; i < static_cast<int>(seconds / kDt); ++i) {
      drive = controller.step(state, wanted_degC, known_load_W, kDt);
      state = step(plant, state, drive.current_A, load_W, kDt);
    }
  }
};

}  // namespace

TEST_CASE("The plate reaches and holds its target with a known or unknown load") {
  const double known_load_W = GENERATE(1.0, 0.0, -0.5);
  Plate plate;
  for (const double wanted : {23.0, 33.0, 40.0, 18.0, 33.0}) {
    plate.follow(wanted, 1.0, 4, known_load_W);
    INFO(wanted);
    CHECK(plate.state.plate_degC == Approx(wanted).margin(0.02));
    CHECK_FALSE(plate.drive.limited);
    CHECK_FALSE(plate.drive.fault);
  }
}

TEST_CASE("Cooling by ten kelvin takes about half a second without overshoot") {
  Plate plate;
  plate.follow(33, 0, 2, 0);
  double lowest = 100;
  int ticks = 0;
  for (; ticks < 3000; ++ticks) {
    plate.follow(23, 0, kDt, 0);
    lowest = std::min(lowest, plate.state.plate_degC);
    if (plate.state.plate_degC < 24) break;
  }
  // 9 K at 20 K/s take 0.45 s; the current of 6 A gives about 17 W or 19 K/s.
  CHECK(ticks * kDt < 0.6);
  plate.follow(23, 0, 2, 0);
  CHECK(plate.state.plate_degC == Approx(23).margin(0.02));
  CHECK(lowest > 22.8);
}

TEST_CASE("Current and voltage stay within their limits for any input") {
  std::mt19937_64 random(9);
  const auto any = [&] {
    const std::uint64_t bits = random();
    double x;
    std::memcpy(&x, &bits, sizeof x);
    return random() % 2 ? x : static_cast<double>(random() % 2000) / 10 - 60;
  };
  const PlateLimits limits;
  for (int trial = 0; trial < 200; ++trial) {
    Plate plate;
    for (int i = 0; i < 100; ++i) {
      const PeltierState measured{any(), any()};
      const PlateDrive d = plate.controller.step(measured, any(), any(), kDt);
      REQUIRE(std::isfinite(d.current_A));
      REQUIRE(std::abs(d.current_A) <= limits.current_A);
      if (d.current_A != 0)
        REQUIRE(std::abs(voltage_V(plate.plant.module, measured, d.current_A)) <= limits.voltage_V * (1 + 1e-9));
    }
  }
}

TEST_CASE("The plate stays within its range and rate for any target") {
  std::mt19937_64 random(10);
  Plate plate;
  const PlateLimits limits;
  for (int i = 0; i < 300; ++i) {
    const double wishes[] = {1e300, -1e300, 100, -100, 43, 10, 33, 20 + static_cast<double>(random() % 20)};
    const double wanted = wishes[random() % std::size(wishes)];
    for (int ms = 0; ms < 200; ++ms) {
      const double before = plate.state.plate_degC;
      plate.follow(wanted, 0.01 * static_cast<double>(random() % 200), kDt, 0);
      REQUIRE(plate.state.plate_degC < limits.plate_max_degC + 0.3);
      REQUIRE(plate.state.plate_degC > limits.plate_min_degC - 0.3);
      // An unknown load of 2 W moves the plate by 2.2 K/s more than planned, and the integral for the previous
      // load by the same amount.
      REQUIRE(std::abs(plate.state.plate_degC - before) <= (limits.rate_K_s + 4.5) * kDt);
    }
  }
}

TEST_CASE("A failed sensor, an invalid target and a hot sink switch the current off") {
  const double nan = std::nan("");
  PlateController c(PeltierPlant{}, PlateLimits{});
  for (const PlateDrive& d : {c.step({nan, 23}, 30, 0, kDt), c.step({33, nan}, 30, 0, kDt),
                              c.step({33, 23}, nan, 0, kDt), c.step({33, 56}, 20, 0, kDt)}) {
    CHECK(d.current_A == 0);
    CHECK(d.fault);
  }
  // A plate beyond its range is led back, and reported as a fault.
  const PlateDrive back = c.step({46, 30}, 33, 0, kDt);
  CHECK(back.fault);
  CHECK(back.current_A > 0);
}
