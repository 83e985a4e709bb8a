#include "audio_node/modal/mode_shape.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "audio_node/modal/modal.h"

using namespace tactus::audio;
using Eigen::Vector3d;

namespace {

const Vector3d kUp = Vector3d::UnitZ();

// Midpoint rule over 0 .. 1.
template <class F>
double mean(F f) {
  constexpr int kSteps = 4000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += f((i + 0.5) / kSteps);
  return sum / kSteps;
}

}  // namespace

TEST_CASE("Beam functions of a free bar have mean square 1 and are orthogonal to each other and to rigid motions") {
  for (int n = 0; n < 12; ++n) {
    CAPTURE(n);
    CHECK(mean([&](double x) { return std::pow(free_beam(n, x).value, 2); }) == Approx(1).epsilon(1e-4));
    CHECK(free_beam(n, 0).value == Approx(2).epsilon(1e-6));
    CHECK(std::abs(free_beam(n, 1).value) == Approx(2).epsilon(1e-6));
    // The centre of mass of a free bar stays in place, and the bar does not rotate as a whole.
    CHECK(mean([&](double x) { return free_beam(n, x).value; }) == Approx(0).margin(1e-4));
    CHECK(mean([&](double x) { return free_beam(n, x).value * (x - 0.5); }) == Approx(0).margin(1e-4));
    for (int k = 0; k < n; ++k)
      CHECK(mean([&](double x) { return free_beam(n, x).value * free_beam(k, x).value; }) ==
            Approx(0).margin(1e-4));
    for (const double x : {0.1, 0.4, 0.77})
      CHECK(
          free_beam(n, x).slope ==
          Approx((free_beam(n, x + 1e-6).value - free_beam(n, x - 1e-6).value) / 2e-6).epsilon(1e-5).margin(1e-4));
  }
  SECTION("the nodes lie at the published places") {
    // Fletcher and Rossing, The Physics of Musical Instruments, table 2.1: 0.224 L; 0.132 and 0.5 L; 0.094, 0.356
    // L.
    for (const auto& [n, x] : {std::pair(0, 0.224), {1, 0.132}, {1, 0.5}, {2, 0.094}, {2, 0.356}}) {
      CAPTURE(n, x);
      CHECK(free_beam(n, x - 0.001).value * free_beam(n, x + 0.001).value < 0);
    }
  }
}

TEST_CASE("A strike on a nodal line of a bar excites no mode, and a strike on its side another bending") {
  const ModeShape low = bar_bending_shape(0, 0.3, 2);
  CHECK(low({0.15, 0, 0.01}, kUp) == Approx(2));
  CHECK(low({0, 0, 0.01}, kUp) < -1.2);
  CHECK(low({0.3 * (0.2242 - 0.5), 0, 0.01}, kUp) == Approx(0).margin(2e-3));
  CHECK(low({0.15, 0, 0.01}, Vector3d::UnitY()) == Approx(0).margin(1e-12));
  SECTION("a push along the bar off its middle bends it by the slope") {
    const double slope = free_beam(0, 1).slope / 0.3;
    CHECK(low({0.15, 0, 0.01}, Vector3d::UnitX()) == Approx(-0.01 * slope));
    CHECK(low({0.15, 0, 0}, Vector3d::UnitX()) == Approx(0).margin(1e-12));
  }
  SECTION("stretching needs a push along the bar, torsion a push off the axis") {
    CHECK(stretching_shape(1, 0.3, 0)({-0.15, 0, 0}, Vector3d::UnitX()) == Approx(std::sqrt(2)));
    CHECK(stretching_shape(1, 0.3, 0)({0, 0, 0}, Vector3d::UnitX()) == Approx(0).margin(1e-12));
    CHECK(stretching_shape(1, 0.3, 0)({-0.15, 0, 0}, kUp) == Approx(0).margin(1e-12));
    CHECK(torsion_shape(1, 0.3, 0, 0.01)({-0.15, 0.01, 0}, kUp) == Approx(std::sqrt(2)));
    CHECK(torsion_shape(1, 0.3, 0, 0.01)({-0.15, 0, 0}, kUp) == Approx(0).margin(1e-12));
  }
  SECTION("a round bar bends in the direction of the push") {
    const ModeShape round = round_bending_shape(0, 0.3);
    for (const double angle : {0., 1., 2., 4.})
      CHECK(round({0, 0, 0.15}, {std::cos(angle), std::sin(angle), 0}) == Approx(2));
  }
}

TEST_CASE("A plate is silent in a mode on its nodal lines, and the corners of a free plate drive all modes") {
  const ModeShape supported = supported_plate_shape(2, 1, 0.4, 0.3, {});
  CHECK(supported({0, 0.02, 0}, kUp) == Approx(0).margin(1e-12));
  CHECK(supported({-0.1, 0, 0}, kUp) == Approx(2));
  CHECK(supported({0.1, 0, 0}, kUp) == Approx(-2));
  CHECK(supported({0.2, 0.1, 0}, kUp) == Approx(0).margin(1e-12));  // at the rim
  CHECK(free_plate_shape(2, 0, 0.4, 0.3)({0.2, 0.15, 0}, kUp) == Approx(2));
  CHECK(free_plate_shape(1, 1, 0.4, 0.3)({0.2, 0.15, 0}, kUp) == Approx(3));
  CHECK(free_plate_shape(1, 1, 0.4, 0.3)({0.1, 0, 0}, kUp) == Approx(0).margin(1e-12));
  SECTION("a patch of a larger plate has no nodal lines") {
    CHECK(supported_plate_shape(2, 1, 0.4, 0.3, {true, true})({0.01, 0.1, 0}, kUp) == Approx(1));
    CHECK(supported_plate_shape(2, 1, 0.4, 0.3, {true, true})({0.01, 0.1, 0}, -kUp) == Approx(-1));
  }
}

TEST_CASE("The modes of a disc have no net momentum, and their circles lie at the values of Leissa") {
  const double R = 0.1;
  const auto radial = [&](int n, int s, double nu) {
    return [shape = free_disc_shape(n, s, R, nu), R](double x) { return shape({x * R, 0, 0}, kUp); };
  };
  for (const double nu : {0.0, 0.2, 0.33, 0.49})
    for (const NaturalFrequency& m : free_disc({2e11, nu, 7850, 0, 0, 0}, R, 0.001, {1e6, 32})) {
      CAPTURE(nu, m.i, m.k);
      const double share = m.i > 0 ? 2 : 1;  // of two degenerate modes
      const auto at = radial(m.i, m.k, nu);
      CHECK(2 * mean([&](double x) { return std::pow(at(x), 2) * x; }) == Approx(share).epsilon(1e-4));
      // Without a diameter the mean displacement is zero; with one, its first moment is zero: free of external
      // forces.
      if (m.i == 0) CHECK(mean([&](double x) { return at(x) * x; }) == Approx(0).margin(1e-5));
      if (m.i == 1) CHECK(mean([&](double x) { return at(x) * x * x; }) == Approx(0).margin(1e-5));
    }
  // Leissa, NASA SP-160, table 2.6, nu = 0.33, radii of the nodal circles.
  for (const auto& [n, s, x] :
       {std::tuple(0, 1, 0.680), {1, 1, 0.781}, {2, 1, 0.823}, {0, 2, 0.391}, {0, 2, 0.841}}) {
    CAPTURE(n, s, x);
    CHECK(radial(n, s, 0.33)(x - 0.006) * radial(n, s, 0.33)(x + 0.006) < 0);
  }
}
