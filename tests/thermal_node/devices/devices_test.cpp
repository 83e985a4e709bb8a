#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <tactus/thermal_device_t.hpp>

#include "lcmtypes/valid.h"
#include "tests/thermal_node/support/device_time.h"
#include "thermal_node/devices/external.h"
#include "thermal_node/devices/make_device.h"
#include "thermal_node/devices/simulated_peltier.h"

using namespace tactus;
using namespace std::chrono_literals;
using thermal::PlateReading;
using tactus::thermal::test::at;

TEST_CASE("The simulated display follows its command and reports its state") {
  thermal::SimulatedPeltier device({}, {}, 33);
  PlateReading r;
  for (int i = 0; i <= 200; ++i) r = *device.step(23, 0.5, at(20 * i));
  CHECK(r.plate_degC == Approx(23).margin(0.05));
  CHECK(r.sink_degC > 23.2);
  CHECK(r.current_A > 0);
  CHECK_FALSE(r.fault);
  for (int i = 201; i <= 400; ++i) r = *device.step(40, 0.5, at(20 * i));
  CHECK(r.plate_degC == Approx(40).margin(0.05));
}

TEST_CASE("Invalid commands and loads keep the simulated display within its limits") {
  thermal::SimulatedPeltier device({}, {}, 33);
  const double inf = std::numeric_limits<double>::infinity();
  int tick = 0;
  for (const double command : {std::nan(""), inf, -inf, 1e300})
    for (const double load : {std::nan(""), inf, -inf}) {
      const PlateReading r = *device.step(command, load, at(20 * ++tick));
      CHECK(std::isfinite(r.plate_degC));
      CHECK(std::abs(r.current_A) <= thermal::PlateLimits{}.current_A);
      CHECK(r.plate_degC < 44);
    }
  // A clock that steps back or jumps ahead does no harm.
  CHECK(std::isfinite(device.step(30, 0, at(-50'000))->plate_degC));
  CHECK(std::isfinite(device.step(30, 0, at(500'000'000))->plate_degC));
}

TEST_CASE("The readings of an external display are used until they stop") {
  thermal::External device(2);
  CHECK_FALSE(device.step(30, 0, at(0)));
  thermal_device_t m = thermal::to_message({25, 31, 1.5, 2, true, false}, 2);
  device.receive(m, at(100));
  REQUIRE(device.step(30, 0, at(120)));
  CHECK(device.step(30, 0, at(120))->plate_degC == 25);
  CHECK(device.step(30, 0, at(120))->limited);
  CHECK(device.step(30, 0, at(400)));
  CHECK_FALSE(device.step(30, 0, at(401)));
  SECTION("Readings of another tool are ignored") {
    m.tool = 1;
    device.receive(m, at(450));
    CHECK_FALSE(device.step(30, 0, at(451)));
  }
}

TEST_CASE("A reading converts to a valid message and back") {
  for (const PlateReading& r :
       {PlateReading{25.5, 40.25, -2.5, 1.5, false, false}, PlateReading{33, 33, 0, 0, true, false},
        PlateReading{10, 12, 6, -3, false, true}}) {
    thermal_device_t m = thermal::to_message(r, 1);
    m.header.run_id = m.header.incarnation = 1;
    CHECK(valid(m));
    const PlateReading back = thermal::to_reading(m);
    CHECK(back.plate_degC == r.plate_degC);
    CHECK(back.sink_degC == r.sink_degC);
    CHECK(back.current_A == r.current_A);
    CHECK(back.voltage_V == r.voltage_V);
    CHECK(back.limited == r.limited);
    CHECK(back.fault == r.fault);
  }
}

TEST_CASE("The settings select the display") {
  thermal::Settings settings;
  const auto made = [&](const char* name) {
    settings.device = name;
    return thermal::make_device(settings, 0, 25);
  };
  CHECK_FALSE(made("none"));
  REQUIRE(made("peltier"));
  CHECK(made("peltier")->simulated());
  CHECK(made("peltier")->step(25, 0, at(0))->plate_degC == 25);
  REQUIRE(made("external"));
  CHECK_FALSE(made("external")->simulated());
}

TEST_CASE("A tight slew limit does not slow down the plate") {
  thermal::Settings settings;
  settings.slew_max_K_s = 0.1;
  const auto device = thermal::make_device(settings, 0, 15);
  PlateReading r;
  for (int i = 0; i <= 30; ++i) r = *device->step(20, 0.5, at(20 * i));
  CHECK(r.plate_degC > 19.8);
}
