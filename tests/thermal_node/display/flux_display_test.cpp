#include "thermal_node/display/flux_display.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "thermal_node/skin/bioheat_model.h"
#include "thermal_node/skin/contact_model.h"
#include "thermal_node/skin/skin_model.h"

using namespace tactus::thermal;

namespace {

const double kPlate = contact_conductance_W_m2K(24);  // alumina

std::unique_ptr<Skin> finger() { return std::make_unique<SkinModel>(SkinProperties{}); }

// A touch, and the finger of a person on a plate that follows its command within `rate`.
struct Felt {
  SkinModel touch{SkinProperties{}}, person{SkinProperties{}};
  FluxDisplay display;
  double plate_degC = 33, conductance, rate_K_s;

  Felt(double feedback, double conductivity, double effusivity, double rate)
      : display({kPlate, feedback}, finger()),
        conductance(contact_conductance_W_m2K(conductivity)),
        rate_K_s(rate) {
    touch.set_object({23, effusivity});
  }
  double error_K() const { return person.surface_degC() - touch.surface_degC(); }
  void tick(bool touching) {
    touch.step(0.02, touching ? conductance : 0, 0);
    const double wanted =
        display.step(touch.surface_degC(), touch.heat_flux_W_m2(), plate_degC, 0.02, Skin::kLongestSubstep_s);
    plate_degC += std::clamp(wanted - plate_degC, -rate_K_s * 0.02, rate_K_s * 0.02);
    person.set_object({plate_degC, 1e9});
    person.step(0.02, kPlate, 0);
  }
};

}  // namespace

TEST_CASE("At rest the target of the plate is the resting temperature") {
  FluxDisplay display({kPlate}, finger());
  for (int i = 0; i < 100; ++i) CHECK(display.step(33, 0, 33, 0.02, 0.005) == Approx(33).margin(1e-9));
}

TEST_CASE("With an ideal plate the finger loses the same heat as to the object") {
  // The command lags the touch by one tick; after the first ten ticks the finger is within 3 % of the change,
  // after a second within 1 %.
  const bool copper = GENERATE(true, false);
  Felt felt(3, copper ? 401 : 0.18, copper ? 37137 : 514, 1e9);
  for (int i = 0; i < 500; ++i) {
    felt.tick(true);
    const double change = 33 - felt.touch.surface_degC();
    if (i >= 10) REQUIRE(std::abs(felt.error_K()) < (i < 50 ? 0.03 : 0.01) * change);
    if (i >= 50) CHECK(felt.person.heat_flux_W_m2() == Approx(felt.touch.heat_flux_W_m2()).epsilon(0.02));
  }
}

TEST_CASE("Feedback compensates the delay of a slow plate at the first moment of a touch") {
  // In the first second the plate limits the change, ten kelvin at 10 K/s; the finger is still warm then.
  const auto error = [](double feedback) {
    Felt felt(feedback, 401, 37137, 10);
    double sum = 0;
    for (int i = 0; i < 150; ++i) {
      felt.tick(true);
      if (i >= 60) sum += felt.error_K() * felt.error_K() / 90;
    }
    return std::sqrt(sum);
  };
  CHECK(error(3) < 0.4 * error(0));
  CHECK(error(3) < error(1));
}

TEST_CASE("Feedback does not oscillate") {
  // The finger responds to a step of the plate within one tick by 1 - erfcx(beta sqrt(t)) = 0.21: a gain of 3 is a
  // loop gain of 0.6. After the touch has settled the target changes in one direction only.
  Felt felt(3, 401, 37137, 20);
  for (int i = 0; i < 200; ++i) felt.tick(true);
  double before = felt.plate_degC;
  for (int i = 0; i < 200; ++i) {
    felt.tick(true);
    CHECK(std::abs(felt.plate_degC - before) < 0.02);
    before = felt.plate_degC;
  }
}

TEST_CASE("After the touch the finger recovers with the touched skin") {
  Felt felt(3, 401, 37137, 20);
  for (int i = 0; i < 100; ++i) felt.tick(true);
  for (int i = 0; i < 250; ++i) {
    felt.tick(false);
    if (i > 50) REQUIRE(std::abs(felt.error_K()) < 0.1);
  }
}

TEST_CASE("A measurement that is not finite does not change the finger") {
  FluxDisplay display({kPlate}, finger());
  for (int i = 0; i < 10; ++i) display.step(30, 1000, 25, 0.02, 0.005);
  const double before = display.finger_degC();
  CHECK(std::isfinite(display.step(30, 1000, NAN, 0.02, 0.005)));
  CHECK(std::isfinite(display.step(30, 1000, INFINITY, 0.02, 0.005)));
  CHECK(display.finger_degC() == before);
}
