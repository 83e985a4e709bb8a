#include "thermal_node/display/quality.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/thermal_node/support/steady_contact.h"
#include "thermal_node/skin/contact_model.h"
#include "thermal_node/skin/skin_model.h"

using namespace tactus;
using namespace tactus::thermal;

namespace {

// Ticks of 20 ms that take `full_ms` at full quality, and half of it at each further step.
int run(Quality& quality, double full_ms, int ticks) {
  for (int i = 0; i < ticks; ++i) quality.add(sync::from_seconds(full_ms * 1e-3 / std::pow(2, quality.step())));
  return quality.step();
}

constexpr double kSkin = 1181.0588469674, kCopper = 37137;  // W s^0.5 m^-2 K^-1

SkinModel touching_copper() {
  SkinModel skin(SkinProperties{33, kSkin, 0, 0});
  skin.set_object({23, kCopper});
  return skin;
}

}  // namespace

TEST_CASE("The substeps grow when ticks take half of their period and shrink again later") {
  Quality quality(Settings{});
  CHECK(run(quality, 8, 500) == 0);
  CHECK(quality.longest_substep_s() == 0.005);
  CHECK(run(quality, 12, 64) == 1);
  CHECK(run(quality, 30, 64) == 2);
  CHECK(quality.longest_substep_s() == 0.02);
  CHECK(run(quality, 4, 50) == 2);
  CHECK(run(quality, 4, 2000) == 0);
}

TEST_CASE("A fixed quality ignores the tick time") {
  Settings settings;
  settings.quality = "2";
  Quality quality(settings);
  CHECK(run(quality, 0.01, 5000) == 2);
}

TEST_CASE("Every quality step follows the closed form") {
  // In space as in the test of the skin model; in time (20 ms/tau)^2/10 = 0.4 % with tau >= 0.1 s: together below
  // 1 % of the change. In the tick of the touch itself the change follows the root of time, and one substep has an
  // error of 7 % of it, 0.15 K.
  const double h = contact_conductance_W_m2K(401);
  const test::SteadyContact exact{kSkin, kCopper, h, 33, 23};
  for (const double substep_s : Quality::kLongestSubsteps_s) {
    SkinModel skin = touching_copper();
    for (int tick = 1; tick <= 500; ++tick) {
      skin.step(0.02, h, 1, substep_s);
      INFO(substep_s << " s after " << 0.02 * tick << " s");
      const double expected = exact.skin_surface_degC(0.02 * tick) - 33;
      CHECK(skin.surface_degC() - 33 == Approx(expected).epsilon(tick > 1 ? 0.01 : 0.08));
    }
  }
}

TEST_CASE("The temperature is continuous when the quality step changes") {
  const double h = contact_conductance_W_m2K(401);
  SkinModel steady = touching_copper(), changing = touching_copper();
  double most = 0;
  for (int tick = 0; tick < 500; ++tick) {
    steady.step(0.02, h, 1);
    changing.step(0.02, h, 1, Quality::kLongestSubsteps_s[static_cast<std::size_t>(tick / 7 % 3)]);
    if (tick > 5) most = std::max(most, std::abs(steady.surface_degC() - changing.surface_degC()));
  }
  CHECK(most > 0);
  CHECK(most < 0.005);  // K, of 8
}
