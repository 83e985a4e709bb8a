#include "thermal_node/skin/contact_model.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace tactus::thermal;

TEST_CASE("Effusivity of skin is that of Ho and Jones") {
  CHECK(effusivity(0.37, 1000, 3770) == Approx(1181.0588469674).epsilon(1e-9));  // sqrt(0.37 * 1000 * 3770)
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
