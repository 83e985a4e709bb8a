#include "audio_node/spatial/diffuse_field.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace tactus::audio;

TEST_CASE("What all directions have in common is undone") {
  // 1 + 0.5 z^-1 has least phase, and the inverse (-0.5)^n, of which 1e-7 is left after 24 samples.
  const auto inverse = diffuse_field_inverse({{1, 0.5f}, {1, 0.5f}, {1, 0.5f}}, 24);
  REQUIRE(inverse.size() == 24);
  for (std::size_t n = 0; n < inverse.size(); ++n)
    CHECK(static_cast<double>(inverse[n]) == Approx(std::pow(-0.5, n)).margin(1e-6));
}
