#include "audio_node/modal/modal.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <tuple>

#include "audio_node/modal/disc.h"
#include "tests/audio_node/support/thick_plates.h"

using namespace tactus::audio;
using namespace tactus::audio::test;
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

TEST_CASE("A thin supported plate has the frequencies of Navier's double sine") {
  const double a = 0.4, b = 0.3, h = 0.0002;
  const double D = kSteel.youngs_modulus_Pa * h * h * h / (12 * (1 - 0.29 * 0.29));
  const auto f = supported_plate(kSteel, a, b, h, {16000, 6});
  REQUIRE(f.size() == 6);
  // Shear and rotary inertia lower them by (k h)^2 / 24 (1 + 3.4): 2.6e-6 for the second.
  CHECK(f[0].frequency_Hz == Approx(pi / 2 * std::sqrt(D / (7850 * h)) * (1 / (a * a) + 1 / (b * b))).epsilon(3e-6));
  CHECK(f[1].frequency_Hz == Approx(pi / 2 * std::sqrt(D / (7850 * h)) * (4 / (a * a) + 1 / (b * b))).epsilon(3e-6));
  CHECK(std::is_sorted(f.begin(), f.end(),
                       [](const NaturalFrequency& x, const NaturalFrequency& y) { return x.frequency_Hz < y.frequency_Hz; }));
}

TEST_CASE("A thick supported plate has the frequencies of three-dimensional elasticity within 5 %") {
  Elastic m = kSteel;
  SECTION("the published ones of a square plate ten times as wide as thick, within 0.7 %") {
    // omega h sqrt(rho / G), nu = 0.3 (Srinivas, Joga Rao and Rao, J. Sound Vib. 12, 1970, p. 187).
    m.poissons_ratio = 0.3;
    const double a = 0.2, h = 0.02, to_published = 2 * pi * h / shear_speed_m_s(m);
    const auto f = supported_plate(m, a, a, h, {1e6, 9});
    const std::pair<std::size_t, double> published[] = {{0, 0.0932}, {1, 0.2226}, {3, 0.3421}, {4, 0.4171}, {6, 0.5239}};
    for (const auto& [i, value] : published) {
      CAPTURE(i);
      CHECK(f[i].frequency_Hz * to_published == Approx(value).epsilon(0.007));
    }
  }
  SECTION("plates three times as wide as thick have 0.76, 0.60 and 0.52 of the frequencies of thin-plate theory") {
    m.poissons_ratio = 0.3;
    const double a = 0.3, h = 0.1;
    const double thin = pi / 2 * h * std::sqrt(m.youngs_modulus_Pa / (12 * m.density_kg_m3 * (1 - 0.09))) / (a * a);
    const auto f = supported_plate(m, a, a, h, {1e6, 4});
    CHECK(f[0].frequency_Hz / (2 * thin) == Approx(0.757).epsilon(2e-3));
    CHECK(f[1].frequency_Hz / (5 * thin) == Approx(0.601).epsilon(2e-3));
    CHECK(f[3].frequency_Hz / (8 * thin) == Approx(0.516).epsilon(2e-3));
  }
  SECTION("random waves in random materials up to k h = 10") {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 300; ++i) {
      m.poissons_ratio = 0.49 * unit(random);
      const double h = 0.01, k = 0.1 * std::pow(100, unit(random)) / h;
      CAPTURE(m.poissons_ratio, k * h);
      CHECK(thick_plate_Hz(m, h, k) == Approx(lamb_wave_Hz(m, h, k)).epsilon(0.05));
      // Up to k h = 1, waves of six thicknesses, within 1.1 %.
      if (k * h < 1) CHECK(thick_plate_Hz(m, h, k) == Approx(lamb_wave_Hz(m, h, k)).epsilon(0.011));
    }
  }
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

TEST_CASE("A free plate of any thickness agrees with Mindlin's equations within 20 %") {
  Elastic m = kSteel;
  for (const double nu : {0.2, 0.35})
    for (const double ratio : {1.0, 1.5, 2.5})
      for (const double slender : {3.0, 5.0, 10.0}) {
        m.poissons_ratio = nu;
        const double b = 0.1, h = b / slender;
        const auto f = free_plate(m, ratio * b, b, h, {1e6, 5});
        const std::vector<double> exact = free_mindlin_plate(m, ratio * b, b, h, 5);
        for (std::size_t i = 0; i < 5; ++i) {
          CAPTURE(nu, ratio, slender, i);
          CHECK(f[i].frequency_Hz == Approx(exact[i]).epsilon(0.20));
        }
      }
}

TEST_CASE("The modes of a free disc agree with published ones of several Poisson's ratios") {
  const auto lambda2 = [](double nu, int diameters, int circles) { return std::pow(free_disc_lambda(diameters, circles, nu), 2); };
  // Leissa, NASA SP-160, table 2.5, nu = 0.33, of several authors, who agree with each other to 0.4 %.
  const std::tuple<int, int, double> leissa[] = {{2, 0, 5.253}, {0, 1, 9.084}, {3, 0, 12.23}, {1, 1, 20.52}, {4, 0, 21.6},
                                                 {5, 0, 33.1},  {2, 1, 35.25}, {0, 2, 38.55}, {3, 1, 52.91}, {1, 2, 59.86}};
  for (const auto& [n, s, value] : leissa) CHECK(lambda2(0.33, n, s) == Approx(value).epsilon(4e-3));
  // nu = 0.3, computed with other implementations of the Bessel functions (SciPy).
  const std::tuple<int, int, double> computed[] = {{2, 0, 5.3583}, {0, 1, 9.0031}, {3, 0, 12.4390}, {1, 1, 20.4746}, {4, 0, 21.8352}};
  for (const auto& [n, s, value] : computed) CHECK(lambda2(0.3, n, s) == Approx(value).epsilon(1e-5));
  SECTION("the lowest mode of rubber is 11 % below that of a material with nu = 0.33, and that of glass 7 % above") {
    CHECK(lambda2(0.49, 2, 0) / lambda2(0.33, 2, 0) == Approx(0.890).epsilon(2e-3));
    CHECK(lambda2(0.2, 2, 0) / lambda2(0.33, 2, 0) == Approx(1.075).epsilon(2e-3));
  }
  SECTION("a thick disc is lower than a thin one") {
    // Mindlin's equations by the method of Ritz, nu = 0.33, thickness 0.4 of the radius: omega R^2 sqrt(rho h / D).
    Elastic m = kSteel;
    m.poissons_ratio = 0.33;
    const double R = 0.05, h = 0.02;
    const double unit = std::sqrt(m.youngs_modulus_Pa / (12 * m.density_kg_m3 * (1 - 0.33 * 0.33))) * h / (2 * pi * R * R);
    const auto f = free_disc(m, R, h, {1e6, 32});
    const double exact[] = {4.552, 7.495, 9.314, 14.049, 14.446};
    for (std::size_t i = 0; i < 5; ++i) CHECK(f[i].frequency_Hz / unit == Approx(exact[i]).epsilon(0.02));
  }
  CHECK(free_disc(kSteel, 0.05, 0.002, {1e6, 32}).size() == 12);
  CHECK_THROWS_AS(free_disc_lambda(4, 1, 0.3), std::logic_error);
}

TEST_CASE("The modes of a solid ball are all roots of its secular equation, for every Poisson's ratio") {
  std::mt19937 random(3);
  for (int draw = 0; draw < 12; ++draw) {
    Elastic m{7e10, 0.25, 2500, 0, 0, 0.5};
    if (draw > 0) m.poissons_ratio = std::uniform_real_distribution<double>(0, 0.499)(random);
    const double nu = m.poissons_ratio, to_x = 2 * pi * 0.1 / shear_speed_m_s(m);
    const auto value = [nu](unsigned order, double x) {
      if (order > 0) return ball_determinant(order, x, nu);
      // The breathing mode: x cot x = 1 - (x^2 / 4)(c_l / c_t)^2 with x = k_l R, times sin x.
      const double ratio2 = 2 * (1 - nu) / (1 - 2 * nu), l = x / std::sqrt(ratio2);
      return l * std::cos(l) - (1 - l * l * ratio2 / 4) * std::sin(l);
    };
    const auto f = solid_ball(m, 0.1, {1e6, 32});
    for (const NaturalFrequency& mode : f) {
      const double x = mode.frequency_Hz * to_x;
      CAPTURE(nu, mode.i, x);
      const auto order = static_cast<unsigned>(mode.i);
      CHECK(value(order, x - 1e-6) * value(order, x + 1e-6) < 0);
    }
    // None is missing.
    std::size_t roots = 0;
    for (unsigned order = 0; order < 11; ++order)
      for (double x = 0.5; x < 8 - 0.005; x += 0.01) roots += value(order, x) * value(order, x + 0.01) < 0;
    CAPTURE(nu);
    CHECK(f.size() == roots);
  }
}

TEST_CASE("The modes of a solid ball agree with published ones") {
  const auto roots = [](double nu, int order) {
    const Elastic m{7e10, nu, 2500, 0, 0, 0.5};
    std::vector<double> out;
    for (const NaturalFrequency& mode : solid_ball(m, 0.1, {1e6, 32}))
      if (mode.i == order) out.push_back(mode.frequency_Hz * 2 * pi * 0.1 / shear_speed_m_s(m));
    return out;
  };
  // Lamb 1882 and Sato and Usami 1962, nu = 1/4: k_t R of the lowest mode of each order.
  const std::pair<int, double> quarter[] = {{0, 4.440}, {1, 3.424}, {2, 2.639}, {3, 3.916}, {4, 5.009}, {5, 6.033}, {6, 7.023}};
  for (const auto& [order, value] : quarter) CHECK(roots(0.25, order).at(0) == Approx(value).margin(2e-3));
  // Love, A Treatise on the Mathematical Theory of Elasticity, section 196: k_t R / pi of the mode of order 2, incompressible: 0.848.
  CHECK(roots(0.499, 2).at(0) / pi == Approx(0.848).margin(1e-3));
  // The breathing mode of glass, steel and aluminium.
  CHECK(roots(0.20, 0).at(0) == Approx(4.018).margin(1e-3));
  CHECK(roots(0.29, 0).at(0) == Approx(4.870).margin(1e-3));
  CHECK(roots(0.33, 0).at(0) == Approx(5.432).margin(1e-3));
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
