#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <tactus/thermal_state_t.hpp>

#include "tests/thermal_node/support/hand.h"
#include "thermal_node/devices/simulated_peltier.h"

using namespace tactus;
using namespace tactus::thermal;

namespace {

// A renderer with a simulated display in its loop, as thermal_node runs them.
struct Displayed {
  explicit Displayed(const Settings& settings) : hand(kMaterials, settings), device({}, {}, 33) {}
  thermal_state_t tick(int material, double force_N) {
    Tick tick = hand.next();
    if (material >= 0) {
      touch(tick, material, force_N);
    }
    reading = *device.step(commanded, hand.renderer.load_W(), tick.end);
    const thermal_state_t state = hand.renderer.step(tick, {.plate = reading});
    commanded = state.commanded_degC;
    return state;
  }
  Hand hand;
  SimulatedPeltier device;
  PlateReading reading;
  double commanded = 33;
};

}  // namespace

TEST_CASE("The plate is colder than the skin by heat flux times contact resistance") {
  Displayed d(with_model(GENERATE("half_space", "bioheat")));
  thermal_state_t state{};
  for (int i = 0; i < 150; ++i) state = d.tick(kCopper, 1);
  const double resistance = 1 / contact_conductance_W_m2K(24);
  // After 3 s the plate has caught up with the touch: 0.2 K for the remaining feedback error and the tick of
  // delay.
  CHECK(d.reading.plate_degC == Approx(state.skin_degC - state.heat_flux_W_m2 * resistance).margin(0.2));
  CHECK(d.reading.plate_degC < state.skin_degC - 1);
  for (int i = 0; i < 500; ++i) state = d.tick(-1, 0);
  CHECK(d.reading.plate_degC == Approx(state.skin_degC).margin(0.1));
}

TEST_CASE("Long contact with a furnace or ice narrows the command before it hurts") {
  const bool furnace = GENERATE(true, false);
  auto materials = kMaterials;
  materials.push_back(material(401, 8960, 385, -100));
  Displayed d(with_model("half_space"));
  d.hand = Hand(materials);
  double warm_s = 0, cold_s = 0;
  for (int i = 0; i < 50 * 500; ++i) {
    const thermal_state_t state = d.tick(furnace ? kFurnace : 3, 20);
    REQUIRE(state.commanded_degC >= 15);
    REQUIRE(state.commanded_degC <= 42);
    REQUIRE(d.reading.plate_degC > 14.5);
    REQUIRE(d.reading.plate_degC < 42.5);
    if (d.reading.plate_degC > 41.5) warm_s += 0.02;
    if (d.reading.plate_degC < 19.5) cold_s += 0.02;
  }
  // In 500 s: 4 min at 42 degC, then none until half of the dose has decayed, which at 39 degC takes 3.5 min; of
  // the cold one minute, then half a minute of rest and half a minute of cold in turn.
  CHECK(warm_s < 300);
  CHECK(cold_s < 350);
  CHECK(warm_s + cold_s > 60);
}

TEST_CASE("The command stays within its range and slew for any reading of the display") {
  const double inf = std::numeric_limits<double>::infinity();
  const double values[] = {std::nan(""), inf, -inf, -300, -20, 0, 15, 33, 42, 43.9, 100, 1e9, 1e300};
  std::mt19937 random(8);
  Hand hand(kMaterials, with_model(GENERATE("half_space", "bioheat")));
  float before = 33;
  for (int i = 0; i < 5000; ++i) {
    Tick tick = hand.next();
    touch(tick, static_cast<int>(random() % 3), 1);
    const auto any = [&] { return values[random() % std::size(values)]; };
    const thermal_state_t state = hand.renderer.step(
        tick, {.plate = PlateReading{any(), any(), any(), any(), random() % 2 == 0, random() % 9 == 0}});
    REQUIRE(std::isfinite(state.skin_degC));
    REQUIRE(state.commanded_degC >= 15);
    REQUIRE(state.commanded_degC <= 42);
    REQUIRE(std::abs(state.commanded_degC - before) <= 20 * 0.02f + 1e-4f);
    REQUIRE(std::isfinite(hand.renderer.load_W()));
    before = state.commanded_degC;
  }
}

TEST_CASE("A plate out of range or with a fault is commanded to rest and reported as limited") {
  for (const PlateReading& bad : {PlateReading{50}, PlateReading{5}, PlateReading{1e9}, PlateReading{std::nan("")},
                                  PlateReading{30, 30, 0, 0, false, true}}) {
    Hand hand;
    hand.press(kCopper, 1, 100);
    thermal_state_t state{};
    for (int i = 0; i < 100; ++i) {
      Tick tick = hand.next();
      touch(tick, kCopper, 1);
      state = hand.renderer.step(tick, {.plate = bad});
      CHECK(state.limited == 1);
    }
    CHECK(state.commanded_degC == 33);
  }
}
