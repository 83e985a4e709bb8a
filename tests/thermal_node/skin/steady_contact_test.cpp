// Tests of the closed form that the skin models are compared with.
#include "tests/thermal_node/support/steady_contact.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "thermal_node/skin/contact_model.h"

using namespace tactus::thermal;
using namespace tactus::thermal::test;

namespace {

constexpr double kSteadySkin = 1181.0588469674;  // sqrt(0.37 * 1000 * 3770)

struct Row {
  const char* name;
  double effusivity, conductivity;
  double after_0_1_s, after_1_s, after_10_s;  // change of skin temperature, K
};
// Skin at 33 degC on an object at 23 degC; evaluated with mpmath from k, rho, c of handbooks; the resistance
// follows from the conductivities (Ho and Jones 2008); two decimals as printed in the reference notes.
const Row kTable[] = {{"copper", 37137, 401, -3.80, -6.77, -8.65},
                      {"aluminium", 24047, 237, -3.78, -6.70, -8.52},
                      {"stainless 304", 7493, 14.9, -3.60, -6.22, -7.79},
                      {"granite", 2385, 2.79, -3.07, -5.04, -6.12},
                      {"marble", 2496, 2.8, -3.09, -5.10, -6.21},
                      {"glass", 1620, 1.4, -2.71, -4.40, -5.31},
                      {"ABS", 514, 0.18, -1.23, -2.15, -2.72},
                      {"oak", 470, 0.17, -1.17, -2.04, -2.56},
                      {"polyurethane foam", 48, 0.03, -0.22, -0.32, -0.37}};

SteadyContact contact(double effusivity, double h) { return {kSteadySkin, effusivity, h, 33, 23}; }

}  // namespace

TEST_CASE("Materials from copper to foam cool the skin by the tabulated values") {
  for (const Row& row : kTable) {
    const SteadyContact c = contact(row.effusivity, contact_conductance_W_m2K(row.conductivity));
    INFO(row.name);
    // The table is rounded to 0.005 K, its conductivities to two digits: 0.02 K in total.
    CHECK(c.skin_surface_degC(0.1) - 33 == Approx(row.after_0_1_s).margin(0.02));
    CHECK(c.skin_surface_degC(1) - 33 == Approx(row.after_1_s).margin(0.02));
    CHECK(c.skin_surface_degC(10) - 33 == Approx(row.after_10_s).margin(0.02));
  }
}

TEST_CASE("A contact begins at rest and ends at the contact temperature") {
  for (const Row& row : kTable) {
    const SteadyContact c = contact(row.effusivity, contact_conductance_W_m2K(row.conductivity));
    CHECK(c.skin_surface_degC(0) == 33);
    // The remaining difference after t is (33 - T)/(beta sqrt(pi t)); at 1e12 s below 1e-5 K.
    CHECK(c.skin_surface_degC(1e12) == Approx(c.contact_degC()).margin(1e-4));
    double before = 33;
    for (double t = 1e-6; t < 1e4; t *= 1.3) {
      const double here = c.skin_surface_degC(t);
      REQUIRE(here < before);
      REQUIRE(here > 23);
      before = here;
    }
  }
}

TEST_CASE("Heat flux out of the skin is that of its surface temperature by Duhamel's integral") {
  // A half-space whose surface follows T(t) gives q(t) = e/sqrt(pi) * integral of T'(s)/sqrt(t - s) ds. With
  // s = t sin^2(a) the singularity vanishes: the midpoint rule with 2000 points then errs below 1e-3 relative,
  // most of it from T' ~ 1/sqrt(s) at the start.
  const SteadyContact c = contact(2385, contact_conductance_W_m2K(2.79));
  for (const double t : {0.05, 0.5, 5.0}) {
    double sum = 0;
    const int n = 2000;
    double previous = 33;
    for (int i = 1; i <= n; ++i) {
      const double a = M_PI / 2 * i / n, mid = M_PI / 2 * (i - 0.5) / n;
      const double here = c.skin_surface_degC(t * std::sin(a) * std::sin(a));
      sum += (previous - here) / std::sqrt(t) / std::cos(mid);
      previous = here;
    }
    CHECK(kSteadySkin / std::sqrt(M_PI) * sum == Approx(c.heat_flux_W_m2(t)).epsilon(2e-3));
  }
}

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
