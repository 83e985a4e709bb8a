#include "thermal_node/skin/skin_model.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/thermal_node/support/steady_contact.h"
#include "thermal_node/skin/contact_model.h"

using namespace tactus::thermal;

namespace {
constexpr double kSkin = 1181.0588469674;    // sqrt(0.37 * 1000 * 3770)
const SkinProperties kDry{33, kSkin, 0, 0};  // no blood, no air: as in the closed form
struct Touched {
  const char* name;
  double effusivity, conductivity;
};
const Touched kMaterials[] = {{"copper", 37137, 401}, {"steel", 7493, 14.9}, {"granite", 2385, 2.79},
                               {"glass", 1620, 1.4},   {"ABS", 514, 0.18},    {"foam", 48, 0.03}};
}  // namespace

TEST_CASE("The numeric skin model follows the closed form from 20 ms to 100 s for every material") {
  // Space: neighbouring cells grow by g - 1 = 12 %, and the centred difference errs by about (g - 1)^2/12 = 0.12 %
  // of the change; the surface cell adds its own width over the depth reached, (0.02)^2/(12 t) < 0.2 % at 20 ms.
  // Time: second order, (5 ms/tau)^2/10 < 0.1 % with tau >= 0.1 s. Together below 0.5 % of the change.
  for (const Touched& m : kMaterials) {
    const double h = contact_conductance_W_m2K(m.conductivity);
    const test::SteadyContact exact{kSkin, m.effusivity, h, 33, 23};
    SkinModel skin(kDry);
    skin.set_object({23, m.effusivity});
    for (int tick = 1; tick <= 5000; ++tick) {
      skin.step(0.02, h, 1);
      const double t = 0.02 * tick, expected = exact.skin_surface_degC(t) - 33;
      INFO(m.name << " at " << t << " s");
      REQUIRE(skin.surface_degC() - 33 == Approx(expected).epsilon(0.005));
      // The flux is that of the middle of the last 5 ms.
      if (tick >= 3) REQUIRE(skin.heat_flux_W_m2() == Approx(exact.heat_flux_W_m2(t - 0.0025)).epsilon(0.01));
    }
  }
}

TEST_CASE("The result is nearly independent of the tick length") {
  const auto after_one_second = [](int ticks) {
    SkinModel skin(SkinProperties{});
    skin.set_object({23, 2385});
    for (int i = 0; i < ticks; ++i) skin.step(1.0 / ticks, 1600, 1);
    return skin.surface_degC();
  };
  const double fine = after_one_second(1000);
  for (const int ticks : {1, 10, 50, 100}) CHECK(after_one_second(ticks) == Approx(fine).margin(0.005));
}

TEST_CASE("The heat of a touch is independent of its place in the tick") {
  // Mean conductance over the tick against the resolved touch: the heat of 5 ms in a tick of 20 ms. Both are
  // linear in a small touch; they differ by the curvature of the flux over the tick, beta sqrt(t) ~ 0.3: below 15
  // %.
  const double h = contact_conductance_W_m2K(401);
  SkinModel mean(kDry), resolved(kDry);
  mean.set_object({23, 37137});
  resolved.set_object({23, 37137});
  mean.step(0.02, h * 0.25, 0.25);
  resolved.step(0.005, h, 1);
  resolved.step(0.015, 0, 0);
  mean.step(0.2, 0, 0);
  resolved.step(0.2, 0, 0);
  CHECK(mean.surface_degC() < 33);
  CHECK(mean.surface_degC() - 33 == Approx(resolved.surface_degC() - 33).epsilon(0.15));
}

TEST_CASE("After the touch the skin returns to rest") {
  SECTION("By conduction alone the skin returns with the square root of time") {
    // Long after a short touch that took the heat Q, a half-space has cooled at its surface by Q/(e sqrt(pi t)).
    SkinModel skin(kDry);
    skin.set_object({23, 37137});
    double heat = 0;
    for (int i = 0; i < 100; ++i) {
      skin.step(0.001, 1870, 1);
      heat += skin.heat_flux_W_m2() * 0.001;
    }
    skin.step(9.95, 0, 0);
    // 10 s after the middle of a touch of 0.1 s the correction is of second order in 0.1/10: 1 % covers the grid
    // and this correction.
    CHECK(33 - skin.surface_degC() == Approx(heat / (kSkin * std::sqrt(M_PI * 10))).epsilon(0.01));
  }
  SECTION("With blood and air the skin returns faster and completely") {
    SkinModel dry(kDry), living(SkinProperties{});
    for (SkinModel* skin : {&dry, &living}) {
      skin->set_object({23, 37137});
      for (int i = 0; i < 500; ++i) skin->step(0.02, 1870, 1);
    }
    CHECK(living.surface_degC() == Approx(dry.surface_degC()).margin(0.2));
    for (SkinModel* skin : {&dry, &living}) skin->step(300, 0, 0);
    CHECK(living.surface_degC() > dry.surface_degC());
    // 300 s of 0.0025/s: exp(-0.75) of the dry deviation remains, and less with air.
    CHECK(33 - living.surface_degC() < std::exp(-0.75) * (33 - dry.surface_degC()));
    living.step(3600, 0, 0);
    CHECK(living.surface_degC() == Approx(33).margin(0.001));
  }
}

TEST_CASE("Energy is conserved between skin and object") {
  // Without blood and air the object gains the heat that the skin loses: with equal effusivities and one
  // conductance the two surfaces stay symmetric about the mean.
  SkinModel skin(kDry);
  skin.set_object({13, kSkin});
  for (int i = 0; i < 1000; ++i) {
    skin.step(0.01, 1000, 1);
    const double gap_K = skin.heat_flux_W_m2() / 1000;  // between the two surfaces
    // The flux is the mean of the last 5 ms, the surface its end: from 0.5 s on that is 0.25 % of at most 10 K.
    if (i < 50) continue;
    REQUIRE(skin.surface_degC() - gap_K / 2 == Approx(23).margin(0.02));
  }
}

TEST_CASE("The skin stays between its own and the object temperature for any input") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 50; ++trial) {
    SkinModel skin(SkinProperties{});
    double low = 33, high = 33;
    for (int i = 0; i < 60; ++i) {
      if (i % 10 == 0) {
        const double object = -100 + 1200 * uniform(random);
        low = std::min(low, object), high = std::max(high, object);
        skin.set_object({object, std::pow(10, 1 + 4 * uniform(random))});
      }
      const double dt = std::pow(10, -5 + 6 * uniform(random));
      skin.step(dt, uniform(random) < 0.3 ? 0 : std::pow(10, 6 * uniform(random)), uniform(random));
      // An L-stable method of second order may overshoot a jump by a small part of it.
      const double slack = 0.05 * (high - low);
      REQUIRE(skin.surface_degC() >= low - slack);
      REQUIRE(skin.surface_degC() <= high + slack);
    }
  }
}

TEST_CASE("An object without properties takes no heat") {
  SkinModel skin(SkinProperties{});
  skin.set_object({1000, 0});
  skin.step(1, 1000, 1);
  CHECK(skin.surface_degC() == 33);
}
