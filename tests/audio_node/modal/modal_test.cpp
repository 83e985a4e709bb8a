#include "audio_node/modal/modal.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace tactus::audio;
using std::numbers::pi;

namespace {

const Elastic kSteel{2.0e11, 0.29, 7850, 5, 3e-8, 0.6};

// Secular determinant of the spheroidal modes of order n of a free solid ball; its roots in x = k_t R are the
// modes (Eringen and Suhubi, Elastodynamics II, 1975, section 8.13).
double ball_determinant(unsigned n, double x, double nu) {
  const double h = x * std::sqrt((1 - 2 * nu) / (2 * (1 - nu)));
  const auto j = [](unsigned m, double y) { return std::sph_bessel(m, y); };
  const double t11 = (n * n - n - x * x / 2) * j(n, h) + 2 * h * j(n + 1, h);
  const double t13 = n * (n + 1) * ((n - 1) * j(n, x) - x * j(n + 1, x));
  const double t41 = (n - 1.0) * j(n, h) - h * j(n + 1, h);
  const double t43 = (n * n - 1 - x * x / 2) * j(n, x) + x * j(n + 1, x);
  return t11 * t43 - t13 * t41;
}

}  // namespace

TEST_CASE("The roots of a free bar are those of Euler and Bernoulli") {
  const double ratios[] = {1, 2.7565, 5.4039, 8.9330, 13.3443};  // of frequencies, given to 4 decimals
  for (int n = 0; n < 5; ++n)
    CHECK(std::pow(free_bar_root(n) / free_bar_root(0), 2) == Approx(ratios[n]).epsilon(2e-5));
  for (int n = 0; n < 8; ++n) {
    // Near a root the slope of the product is cosh x; an error of 1e-6 in x leaves 1e-6 cosh x.
    const double x = free_bar_root(n);
    CHECK(std::abs(std::cos(x) * std::cosh(x) - 1) < 1e-6 * std::cosh(x) + 1e-3 * (n >= 4));
  }
}

TEST_CASE("A thick bar is lower than a thin one and tends to it") {
  for (const double h : {0.0005, 0.02}) {
    const auto thick = thick_bar_bending(kSteel, 0.3, h / std::sqrt(12), {1e6, 3});
    REQUIRE(thick.size() == 3);
    // A steel bar, 0.3 m long, 0.5 mm thick: 28.82 Hz from (4.73004)^2 h sqrt(E/12 rho) / (2 pi L^2).
    if (h < 0.001) CHECK(thick[0].frequency_Hz == Approx(28.82).epsilon(2e-4));
    for (std::size_t i = 0; i < 3; ++i) {
      const double br = free_bar_root(static_cast<int>(i)) / 0.3 * h / std::sqrt(12);
      const double thin_Hz = br * br / (h / std::sqrt(12)) * bar_speed_m_s(kSteel) / (2 * pi);
      CHECK(thick[i].frequency_Hz < thin_Hz);
      // 1 - f/f0 <= (beta r)^2 (1 + 3.1) / 2
      CHECK(1 - thick[i].frequency_Hz / thin_Hz < 2.1 * br * br);
    }
  }
}

TEST_CASE("A supported plate has the frequencies of Navier's double sine") {
  const double a = 0.4, b = 0.3, h = 0.002;
  const double D = kSteel.youngs_modulus_Pa * h * h * h / (12 * (1 - 0.29 * 0.29));
  const auto f = supported_plate(kSteel, a, b, h, {16000, 6});
  REQUIRE(f.size() == 6);
  CHECK(f[0].frequency_Hz == Approx(pi / 2 * std::sqrt(D / (7850 * h)) * (1 / (a * a) + 1 / (b * b))));
  CHECK(f[1].frequency_Hz == Approx(pi / 2 * std::sqrt(D / (7850 * h)) * (4 / (a * a) + 1 / (b * b))));
  CHECK(std::is_sorted(f.begin(), f.end(),
                       [](const NaturalFrequency& x, const NaturalFrequency& y) { return x.frequency_Hz < y.frequency_Hz; }));
}

TEST_CASE("A free square plate agrees with Leissa's exact values within the error of Warburton's method") {
  // Leissa, J. Sound Vib. 31, 1973, table C21: lambda^2 = 13.489, 19.789, 24.432, 35.024, 35.024 for nu = 0.3. The
  // beam functions of the second and third are one degenerate pair, (2,0) and (0,2): 22.4 for both, with errors of
  // 13 % and 9 %.
  Elastic m = kSteel;
  m.poissons_ratio = 0.3;
  const double a = 0.5, h = 0.002;
  const double unit =
      std::sqrt(m.youngs_modulus_Pa * h * h / (12 * m.density_kg_m3 * (1 - 0.09))) / (2 * pi * a * a);
  const auto f = free_plate(m, a, a, h, {16000, 5});
  REQUIRE(f.size() == 5);
  const double exact[] = {13.489, 19.789, 24.432, 35.024, 35.024};
  for (std::size_t i = 0; i < 5; ++i) CHECK(f[i].frequency_Hz / unit == Approx(exact[i]).epsilon(0.15));
}

TEST_CASE("The modes of a solid ball are roots of its secular equation") {
  const Elastic m{7e10, 0.25, 2500, 0, 0, 0.5};
  const double to_x = 2 * pi * 0.1 / shear_speed_m_s(m);
  const auto f = solid_ball(m, 0.1, {1e6, 32});
  REQUIRE(f.size() == 10);
  // Each tabulated k_t R is given to 3 decimals: the determinant of its order changes sign within +-0.001 of it.
  // The breathing mode is of order 0: x cot x = 1 - (x^2 / 4)(c_l / c_t)^2 with x = k_l R and (c_l / c_t)^2 = 3.
  const unsigned order[] = {2, 1, 3, 0, 2, 4, 5, 3, 1, 6};
  for (std::size_t i = 0; i < 10; ++i) {
    const double x = f[i].frequency_Hz * to_x;
    const auto g = [&](double y) {
      const double l = y / std::sqrt(3.0);
      return order[i] == 0 ? l / std::tan(l) - 1 + 0.75 * l * l : ball_determinant(order[i], y, 0.25);
    };
    CAPTURE(i, x);
    CHECK(g(x - 0.001) * g(x + 0.001) < 0);
  }
}

TEST_CASE("The modes of a thin spherical shell obey the membrane equation") {
  const double nu = kSteel.poissons_ratio, R = 0.2;
  const auto f = spherical_shell(kSteel, R, {1e6, 10});
  for (std::size_t i = 0; i < f.size(); ++i) {
    const double l = (static_cast<double>(i) + 2) * (static_cast<double>(i) + 3);
    const double o2 = std::pow(2 * pi * f[i].frequency_Hz * R, 2) * kSteel.density_kg_m3 * (1 - nu * nu) /
                      kSteel.youngs_modulus_Pa;
    CHECK(o2 * o2 - (1 + 3 * nu + l) * o2 + (1 - nu * nu) * (l - 2) == Approx(0).margin(1e-9 * l * l));
    // The lower branch tends to that of a longitudinal bar wave around the ball, c / R.
    CHECK(2 * pi * f[i].frequency_Hz * R < bar_speed_m_s(kSteel));
  }
}

TEST_CASE("Rayleigh damping grows with the square of frequency") {
  CHECK(damping_1_s(kSteel, 0) == Approx(2.5));
  CHECK(damping_1_s(kSteel, 1000) == Approx((5 + 3e-8 * std::pow(2 * pi * 1000, 2)) / 2));
}
