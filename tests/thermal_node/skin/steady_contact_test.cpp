#include "thermal_node/skin/erfcx.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using tactus::thermal::erfcx;

TEST_CASE("erfcx agrees with 40-digit values to 1e-14") {
  // mpmath 1.3, exp(x^2) erfc(x) with 40 digits; from x = 100 on its asymptotic series (Abramowitz and
  // Stegun 7.1.23).
  const double table[][2] = {
      {0, 1.0},
      {1e-8, 0.999999988716208429},
      {0.001, 0.998872620081151409},
      {0.1, 0.896456979969126637},
      {0.5, 0.615690344192925875},
      {1, 0.427583576155807004},
      {2, 0.255395676310505744},
      {3, 0.17900115118138995},
      {3.999999, 0.136999490008574955},
      {4, 0.13699945762506139},
      {4.5, 0.122484804273841418},
      {6, 0.0927765678005383544},
      {10, 0.0561409927438225859},
      {26, 0.0216835848505629066},
      {27, 0.0208816079904209407},
      {100, 5.6416137829894329e-3},
      {1e4, 5.64189580726808412e-5},
      {1e8, 5.64189583547756259e-9},
      {1e150, 5.64189583547756298e-151},
  };
  for (const auto& [x, expected] : table) {
    INFO("x = " << x);
    CHECK(std::abs(erfcx(x) - expected) <= 1e-14 * expected);
  }
}

TEST_CASE("erfcx decreases monotonically, also where its two formulas meet") {
  double before = erfcx(0);
  CHECK(before == 1);
  for (double x = 0.001; x < 50; x += 0.001) {
    const double here = erfcx(x);
    REQUIRE(here < before);
    before = here;
  }
}

TEST_CASE("erfcx stays between the classical bounds for any argument") {
  // Abramowitz and Stegun 7.1.13: 2/(x + sqrt(x^2 + 2)) < sqrt(pi) erfcx(x) <= 2/(x + sqrt(x^2 + 4/pi)).
  for (double x = 1e-6; x < 1e6; x *= 1.1) {
    const double scaled = std::sqrt(M_PI) * erfcx(x);
    REQUIRE(scaled > 2 / (x + std::sqrt(x * x + 2)) * (1 - 1e-14));
    REQUIRE(scaled <= 2 / (x + std::sqrt(x * x + 4 / M_PI)) * (1 + 1e-14));
  }
}

TEST_CASE("erfcx of infinity is zero, and erfcx of NaN is NaN") {
  CHECK(erfcx(std::numeric_limits<double>::infinity()) == 0);
  CHECK(std::isnan(erfcx(std::nan(""))));
}
