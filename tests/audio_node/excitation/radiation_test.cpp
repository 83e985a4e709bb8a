#include "audio_node/excitation/radiation.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace tactus::audio;

namespace {

// Pressure at 1 m ahead of a ball whose velocity rises to `velocity` within `length` under a raised cosine of force, integrated
// by Runge and Kutta: p'' + 2 (c/a) p' + 2 (c/a)^2 p = rho c a A', the dipole field whose velocity at the ball is that of the ball.
double simulated_peak_Pa(double velocity, double length, double radius) {
  const double c = kSoundSpeed_m_s, s = c / radius, w = 2 * std::numbers::pi / length;
  const auto jerk = [&](double t) { return t < length ? velocity / length * w * std::sin(w * t) : 0; };
  const auto slope = [&](double t, double p, double dp) {
    return kAirDensity_kg_m3 * c * radius * jerk(t) - 2 * s * dp - 2 * s * s * p;
  };
  const double end = length + 4 / s, dt = std::min(length, 1 / s) / 1000;
  double p = 0, dp = 0, peak = 0;
  for (double t = 0; t < end; t += dt) {
    const double a1 = slope(t, p, dp), v2 = dp + a1 * dt / 2, a2 = slope(t + dt / 2, p + dp * dt / 2, v2);
    const double v3 = dp + a2 * dt / 2, a3 = slope(t + dt / 2, p + v2 * dt / 2, v3);
    const double v4 = dp + a3 * dt, a4 = slope(t + dt, p + v3 * dt, v4);
    p += dt / 6 * (dp + 2 * v2 + 2 * v3 + v4), dp += dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    peak = std::max(peak, std::abs(p));
  }
  return peak;
}

}  // namespace

TEST_CASE("An oscillating ball radiates as a dipole when it is small and as a plane source when it is large") {
  // rho c v a (ka)^2 / 2 and rho c v a.
  const double k = 2 * std::numbers::pi * 1000 / kSoundSpeed_m_s;
  CHECK(radiation_m(1000, 0.001) == Approx(0.001 * std::pow(k * 0.001, 2) / 2).epsilon(1e-6));
  CHECK(radiation_m(1000, 10) == Approx(10).epsilon(1e-6));
}

TEST_CASE("The click of a small or slowly accelerated ball is the jerk of its dipole") {
  // rho a^3 2 pi J / (2 c m T^2): the acceleration J / (m T) (1 - cos 2 pi t / T) has the largest slope 2 pi J / (m T^2).
  const double a = 0.01, T = 0.002, v = 0.3;  // ka = 0.09
  const double compact = kAirDensity_kg_m3 * a * a * a * 2 * std::numbers::pi * v / (2 * kSoundSpeed_m_s * T * T);
  CHECK(acceleration_peak_Pa(v, T, a) == Approx(compact).epsilon(1e-3));
  SECTION("so it is 2 pi below an oscillation whose velocity is the whole change of velocity, 16 dB") {
    const double whole = kAirDensity_kg_m3 * kSoundSpeed_m_s * v * radiation_m(1 / T, a);
    CHECK(20 * std::log10(whole / acceleration_peak_Pa(v, T, a)) == Approx(15.96).margin(0.02));
  }
}

TEST_CASE("The click of a ball that is accelerated at once is rho c a times its change of velocity") {
  CHECK(acceleration_peak_Pa(0.5, 1e-7, 0.1) == Approx(kAirDensity_kg_m3 * kSoundSpeed_m_s * 0.1 * 0.5).epsilon(1e-3));
}

TEST_CASE("The click of any accelerated ball is the peak of its simulated pressure") {
  std::mt19937 random(4);
  const auto draw = [&](double from, double to) { return from * std::pow(to / from, std::uniform_real_distribution<double>(0, 1)(random)); };
  for (int i = 0; i < 60; ++i) {
    const double a = draw(1e-3, 0.5), T = a / kSoundSpeed_m_s * draw(0.1, 300), v = draw(1e-3, 5);
    CAPTURE(a, T, v);
    CHECK(acceleration_peak_Pa(v, T, a) == Approx(simulated_peak_Pa(v, T, a)).epsilon(3e-4));
  }
}

TEST_CASE("A click rises with the change of velocity in proportion, and falls with the time that it takes") {
  std::mt19937 random(5);
  const auto draw = [&](double from, double to) { return from * std::pow(to / from, std::uniform_real_distribution<double>(0, 1)(random)); };
  for (int i = 0; i < 500; ++i) {
    const double a = draw(1e-3, 1), T = draw(1e-5, 0.02), v = draw(1e-3, 5);
    CHECK(acceleration_peak_Pa(2 * v, T, a) == Approx(2 * acceleration_peak_Pa(v, T, a)));
    CHECK(acceleration_peak_Pa(v, 1.1 * T, a) < acceleration_peak_Pa(v, T, a));
  }
  CHECK(acceleration_peak_Pa(0, 1e-3, 0.01) == 0);
  CHECK(acceleration_peak_Pa(1, 0, 0.01) == 0);
  CHECK(acceleration_peak_Pa(1, 1e-3, 0) == 0);
}
