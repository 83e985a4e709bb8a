#include "audio_node/excitation/contact_patch.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "audio_node/modal/finish.h"

using namespace tactus::audio;

TEST_CASE("A steel ball of 10 mm on steel under 1 N has the Hertzian patch of 41 um") {
  const Elastic steel{2.0e11, 0.29, 7850, 5, 3e-8, 0.6};
  // E* = E / 2 / (1 - nu^2) = 109 GPa; a^3 = 3 * 1 * 0.01 / (4 * 109e9).
  CHECK(reduced_modulus_Pa(steel, steel) == Approx(1.0918e11).epsilon(1e-3));
  const double a = patch_radius_m(1, 1 / 0.01, reduced_modulus_Pa(steel, steel));
  CHECK(a == Approx(40.95e-6).epsilon(1e-3));
  CHECK(patch_radius_m(8, 100, 1e11) == Approx(2 * patch_radius_m(1, 100, 1e11)));
  // At 0.5 m/s 6 kHz; without a patch, all frequencies.
  CHECK(patch_cutoff_Hz(0.5, a) == Approx(0.5 / (2 * a)));
  CHECK(std::isfinite(patch_cutoff_Hz(0.5, 0)));
}

TEST_CASE("A material has the finish of the most similar known material") {
  const Elastic steel{2.0e11, 0.29, 7850, 5, 3e-8, 0.6}, glass{6.2e10, 0.2, 2600, 1, 1e-7, 0.6};
  const Elastic concrete{3.1e10, 0.2, 2250, 6, 3e-6, 0.6};
  CHECK(finish_m(steel) == 1.6e-6);
  CHECK(finish_m(glass) == 0.2e-6);
  CHECK(finish_m(concrete) == 25e-6);
}

TEST_CASE(
    "A rolling body receives the force of waves as long as its patch, or follows them when it is light or slow") {
  const double reduced = 1.1e11, radius_m = 0.01, force_N = 1, mass_kg = 0.03;
  const double a = patch_radius_m(force_N, 1 / radius_m, reduced);
  // Hertz' law F = 4/3 E* R^(1/2) d^(3/2), at d = a^2 / R, changed by the height of a wave of length 2 a and slope
  // 1.
  const auto hertz = [&](double d) { return 4.0 / 3 * reduced * std::sqrt(radius_m) * std::pow(d, 1.5); };
  const double deep = a * a / radius_m, little = 1e-6 * deep, wave_m = 2 * a / (2 * M_PI);
  CHECK(hertz(deep) == Approx(force_N));
  const double spring = (hertz(deep + little) - hertz(deep - little)) / (2 * little);
  CHECK(rolling_force_N(a, reduced, mass_kg, 10) == Approx(spring * wave_m).epsilon(1e-6));
  // At 1 mm/s a wave passes at 12 Hz: mass times the acceleration of its height.
  const double at_rad_s = 2 * M_PI * 0.001 / (2 * a);
  CHECK(rolling_force_N(a, reduced, mass_kg, 0.001) == Approx(mass_kg * at_rad_s * at_rad_s * wave_m));
  CHECK(rolling_force_N(a, reduced, mass_kg, 0) == 0);
}
