#include "audio_node/spatial/air.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

using namespace tactus::audio;

TEST_CASE("The absorption of air agrees with the table of ISO 9613-2") {
  struct Row {
    double temperature_degC, humidity_percent;
    std::vector<double> dB_km;  // octaves from 63 Hz to 8 kHz
  };
  // ISO 9613-2:1996, table 2, computed there by ISO 9613-1 at the exact midband frequencies.
  const Row row = GENERATE(Row{10, 70, {0.1, 0.4, 1.0, 1.9, 3.7, 9.7, 32.8, 117}},
                           Row{20, 70, {0.1, 0.3, 1.1, 2.8, 5.0, 9.0, 22.9, 76.6}},
                           Row{30, 70, {0.1, 0.3, 1.0, 3.1, 7.4, 12.7, 23.1, 59.3}},
                           Row{15, 20, {0.3, 0.6, 1.2, 2.7, 8.2, 28.2, 88.8, 202}},
                           Row{15, 50, {0.1, 0.5, 1.2, 2.2, 4.2, 10.8, 36.2, 129}},
                           Row{15, 80, {0.1, 0.3, 1.1, 2.4, 4.1, 8.3, 23.7, 82.8}});
  for (std::size_t i = 0; i < row.dB_km.size(); ++i) {
    const double f = 1000 * std::pow(10, 0.3 * (static_cast<double>(i) - 4));
    INFO(row.temperature_degC << " degrees, " << row.humidity_percent << " %, " << f << " Hz");
    // Half of the last printed digit, and the uncertainty of three-digit constants.
    const double half = row.dB_km[i] >= 100 ? 0.5 : 0.05;
    CHECK(std::abs(1000 * absorption_dB_m(f, {row.temperature_degC, row.humidity_percent, 101325}) -
                   row.dB_km[i]) <= half + 1e-3 * row.dB_km[i]);
  }
}

TEST_CASE("The low-pass of the air has the absorption at 8 kHz, and nearly that below") {
  const double rate_Hz = GENERATE(44100.0, 48000.0, 96000.0), distance_m = GENERATE(3.0, 10.0, 30.0);
  const auto keep = static_cast<double>(air_keep(absorption_dB_m(kAirFit_Hz) * distance_m, rate_Hz));
  const auto lost_dB = [&](double f) {
    return -20 *
           std::log10((1 - keep) / std::abs(1.0 - keep * std::polar(1.0, -2 * std::numbers::pi * f / rate_Hz)));
  };
  CHECK(lost_dB(8000) == Approx(absorption_dB_m(8000) * distance_m).epsilon(1e-4));  // float
  // Below 8 kHz the error is never larger than the smallest audible difference of level, up to 30 m.
  for (double f = 100; f < 8000; f *= 1.1) CHECK(std::abs(lost_dB(f) - absorption_dB_m(f) * distance_m) < 1);
  CHECK(air_keep(0, rate_Hz) == 0);
}
