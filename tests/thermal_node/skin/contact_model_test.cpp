#include "thermal_node/skin/contact_model.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace tactus::thermal;

namespace {

constexpr double kSkin = 1181.0588469674;  // sqrt(0.37 * 1000 * 3770)

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

SteadyContact contact(double effusivity, double h) { return {kSkin, effusivity, h, 33, 23}; }

}  // namespace

TEST_CASE("Effusivity of skin is that of Ho and Jones") {
  CHECK(effusivity(0.37, 1000, 3770) == Approx(kSkin).epsilon(1e-9));
  CHECK(effusivity(-1, 1000, 3770) == 0);
  CHECK(effusivity(std::numeric_limits<double>::infinity(), 1000, 3770) == 0);
  CHECK(effusivity(std::nan(""), 1000, 3770) == 0);
}

TEST_CASE("Contact resistance of Ho and Jones: 5.4e-4 for metals, 1.6e-3 for plastics") {
  CHECK(1 / contact_conductance_W_m2K(401) == Approx(5.4e-4).epsilon(0.01));
  CHECK(1 / contact_conductance_W_m2K(0.18) == Approx(1.6e-3).epsilon(0.03));
  CHECK(contact_conductance_W_m2K(0) == 0);
  CHECK(contact_conductance_W_m2K(-1) == 0);
  CHECK(contact_conductance_W_m2K(std::nan("")) == 0);
}

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
    CHECK(kSkin / std::sqrt(M_PI) * sum == Approx(c.heat_flux_W_m2(t)).epsilon(2e-3));
  }
}

TEST_CASE(
    "The conductance of a contact is nearly proportional to its force and limited to that of the whole pad") {
  const Press press;
  CHECK(contact_share(1, 1e-4, press) == Approx(1));
  CHECK(contact_share(100, 1e-4, press) == 1);
  CHECK(contact_share(0.1, 1e-4, press) == Approx(std::pow(0.1, 0.95)));
  CHECK(contact_share(0.1, 1e-5, press) == Approx(std::pow(0.1, 0.95) * std::pow(0.1, 0.05)));
  SECTION("A point contact counts as a square millimetre") {
    CHECK(contact_share(0.5, 0, press) == contact_share(0.5, 1e-6, press));
  }
  SECTION("The conductance is zero without force and for values that are not finite") {
    CHECK(contact_share(0, 1e-4, press) == 0);
    CHECK(contact_share(-1, 1e-4, press) == 0);
    CHECK(contact_share(std::nan(""), 1e-4, press) == 0);
    CHECK(contact_share(1, std::nan(""), press) == 0);
    CHECK(contact_share(std::numeric_limits<double>::infinity(), 1e-4, press) == 0);
  }
  SECTION("The conductance never decreases with force") {
    double before = 0;
    for (double f = 1e-3; f < 100; f *= 1.2) {
      const double here = contact_share(f, 2e-5, press);
      CHECK(here >= before);
      before = here;
    }
  }
}
