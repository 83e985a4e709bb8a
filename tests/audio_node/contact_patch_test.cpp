#include "audio_node/contact_patch.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "audio_node/finish.h"

using namespace tactus::audio;

TEST_CASE("A ball of steel of 10 mm on steel under 1 N has Hertz' patch of 41 um") {
  const Elastic steel{2.0e11, 0.29, 7850, 5, 3e-8, 0.6};
  // E* = E / 2 / (1 - nu^2) = 109 GPa; a^3 = 3 * 1 * 0.01 / (4 * 109e9).
  CHECK(reduced_modulus_Pa(steel, steel) == Approx(1.0918e11).epsilon(1e-3));
  const double a = patch_radius_m(1, 1 / 0.01, reduced_modulus_Pa(steel, steel));
  CHECK(a == Approx(40.95e-6).epsilon(1e-3));
  CHECK(patch_radius_m(8, 100, 1e11) == Approx(2 * patch_radius_m(1, 100, 1e11)));
  // At 0.5 m/s 6 kHz; without a patch, all.
  CHECK(patch_cutoff_Hz(0.5, a) == Approx(0.5 / (2 * a)));
  CHECK(std::isfinite(patch_cutoff_Hz(0.5, 0)));
}

TEST_CASE("A material has the finish of the one that it is most alike, whatever its name") {
  const Elastic steel{2.0e11, 0.29, 7850, 5, 3e-8, 0.6}, glass{6.2e10, 0.2, 2600, 1, 1e-7, 0.6};
  const Elastic concrete{3.1e10, 0.2, 2250, 6, 3e-6, 0.6};
  CHECK(finish_m(steel) == 1.6e-6);
  CHECK(finish_m(glass) == 0.2e-6);
  CHECK(finish_m(concrete) == 25e-6);
}
