#include "thermal_node/display/peltier.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace tactus::thermal;

namespace {
const PeltierModule kModule = PeltierModule::from(kTm31_14_85);
}

TEST_CASE("The module reproduces its data sheet, including values that were not used to fit it") {
  const PeltierState farthest{27 - 70, 27};
  CHECK(pumped_W(kModule, farthest, 8.5) == Approx(0).margin(1e-9));
  CHECK(voltage_V(kModule, farthest, 8.5) == Approx(3.8));
  // The largest difference: neither more nor less current pumps more.
  CHECK(pumped_W(kModule, farthest, 8.4) < 0);
  CHECK(pumped_W(kModule, farthest, 8.6) < 0);
  // Values that were not used to make it: 0.35 ohm within its 10 %; 18.8 W without a difference, with 10 % for the
  // effects that a lumped model omits (the Thomson effect and the temperature dependence).
  CHECK(kModule.resistance_ohm == Approx(0.35).epsilon(0.1));
  CHECK(pumped_W(kModule, {27, 27}, 8.5) == Approx(18.8).epsilon(0.1));
}

TEST_CASE("The current for a heat flow pumps that heat flow or the maximum") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const PeltierState s{25 + 15 * uniform(random), 35 + 20 * uniform(random)};
    const double best = kModule.seebeck_V_K * (s.plate_degC + 273.15) / kModule.resistance_ohm;
    const double most = pumped_W(kModule, s, best), wanted = 30 * uniform(random);
    const double current = current_for_A(kModule, s, wanted);
    CHECK(current <= best);
    CHECK(pumped_W(kModule, s, current) == Approx(std::min(wanted, most)).margin(1e-9));
  }
}

TEST_CASE("Heat from the supply and the skin is conserved in plate, sink and room") {
  PeltierPlant plant;
  PeltierState s;
  double balance_J = 0;
  const auto stored = [&] { return plant.plate_J_K * s.plate_degC + plant.sink_J_K * s.sink_degC; };
  const double before_J = stored();
  for (int i = 0; i < 20000; ++i) {
    const double current = 6 * std::sin(0.001 * i), load = 1.5 * std::cos(0.0007 * i);
    const PeltierState old = s;
    s = step(plant, s, current, load, 0.001);
    const PeltierState middle{(old.plate_degC + s.plate_degC) / 2, (old.sink_degC + s.sink_degC) / 2};
    balance_J += 0.001 * (current * voltage_V(plant.module, middle, current) + load -
                          (middle.sink_degC - plant.room_degC) / plant.sink_to_room_K_W);
  }
  // Trapezium against midpoint, both of second order in 1 ms over seconds: 1e-6 of the approximately 100 J of the
  // run.
  CHECK(stored() - before_J == Approx(balance_J).margin(1e-4));
}

TEST_CASE("Without current plate and sink reach the room temperature") {
  PeltierPlant plant;
  PeltierState s{43, 23};
  s = step(plant, s, 0, 0, 0.001);
  // C dT/dt = -K (T_p - T_s)
  CHECK((43 - s.plate_degC) / 0.001 == Approx(kModule.conductance_W_K * 20 / plant.plate_J_K).epsilon(1e-3));
  for (int i = 0; i < 600'000; ++i) s = step(plant, s, 0, 0, 0.001);
  CHECK(s.plate_degC == Approx(23).margin(0.01));
  CHECK(s.sink_degC == Approx(23).margin(0.01));
}

TEST_CASE("Cooling heats the sink by the pumped heat plus the electric power") {
  PeltierPlant plant;
  PeltierState s{33, 23};
  for (int i = 0; i < 600'000; ++i) s = step(plant, s, 2, 0.5, 0.001);
  // Steady state: the pumped heat is the load; all of it and the heat of the supply go to the room.
  CHECK(pumped_W(plant.module, s, 2) == Approx(0.5).margin(1e-3));
  CHECK((s.sink_degC - 23) / plant.sink_to_room_K_W ==
        Approx(0.5 + 2 * voltage_V(plant.module, s, 2)).epsilon(1e-3));
}
