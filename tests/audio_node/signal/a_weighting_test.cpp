#include "audio_node/signal/a_weighting.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace tactus::audio;
using std::numbers::pi;

namespace {

// IEC 61672-1:2013, annex E, equation E.6: in dB, 0 at 1 kHz.
double curve_dB(double f) {
  const auto sq = [](double x) { return x * x; };
  const auto weight = [&](double f2) {
    return sq(12194.217) * f2 * f2 /
           ((f2 + sq(20.598997)) * std::sqrt((f2 + sq(107.65265)) * (f2 + sq(737.86223))) * (f2 + sq(12194.217)));
  };
  return 20 * std::log10(weight(f * f) / weight(1e6));
}

// Level of a tone of `f` after the transient of the slowest pole (e^-129 after a second): from its in-phase and
// quadrature parts, over whole periods, since the frequencies are whole numbers.
double measured_dB(double f, double rate_Hz) {
  AWeighting filter(rate_Hz);
  double in_phase = 0, other = 0;
  const int second = static_cast<int>(rate_Hz);
  for (int n = 0; n < 2 * second; ++n) {
    const double phase = 2 * pi * f * (n % second) / rate_Hz, y = filter.next(std::sin(phase));
    if (n >= second) in_phase += y * std::sin(phase), other += y * std::cos(phase);
  }
  return 20 * std::log10(std::hypot(in_phase, other) * 2 / second);
}

double bent(double f, double rate_Hz) { return rate_Hz / pi * std::tan(pi * f / rate_Hz); }

struct Row {
  double frequency_Hz, weight_dB, above_dB, below_dB;  // nominal; limits of class 1
};
// IEC 61672-1:2013, table 3; exact frequencies are 1000 times powers of 10^0.1, here to the nearest Hz.
constexpr Row kTable[] = {{63, -26.2, 1, 1},   {126, -16.1, 1, 1},  {251, -8.6, 1, 1},
                          {501, -3.2, 1, 1},   {1000, 0, .7, .7},   {1995, 1.2, 1, 1},
                          {3981, 1.0, 1, 1},   {6310, -.1, 1.5, 2}, {7943, -1.1, 1.5, 2.5},
                          {10000, -2.5, 2, 3}, {12589, -4.3, 2, 5}, {15849, -6.6, 2.5, 16}};

}  // namespace

TEST_CASE("A-weighting has the curve of the standard at the warped frequency, at any rate") {
  for (const double rate_Hz : {8000., 22050., 44100., 48000., 96000., 192000.})
    for (const double f : {20., 31., 100., 440., 1000., 2000., 3500., 7000., 9000., 18000., 40000.}) {
      if (f >= 0.48 * rate_Hz) continue;
      CAPTURE(rate_Hz, f);
      // Only rounding: 1e-16 of states that are up to (rate / f1)^2 times the output.
      CHECK(measured_dB(f, rate_Hz) ==
            Approx(curve_dB(bent(f, rate_Hz)) - curve_dB(bent(1000, rate_Hz))).margin(1e-4));
    }
}

TEST_CASE("A-weighting is within class 1 of the standard from 44.1 kHz on, and up to 2 kHz at 8 kHz") {
  for (const double rate_Hz : {8000., 44100., 48000., 96000., 192000.})
    for (const Row& row : kTable) {
      if (row.frequency_Hz > 0.25 * rate_Hz && rate_Hz < 44100) continue;
      const double off_dB = measured_dB(row.frequency_Hz, rate_Hz) - row.weight_dB;
      CAPTURE(rate_Hz, row.frequency_Hz, off_dB);
      CHECK(off_dB <= row.above_dB);
      CHECK(off_dB >= -row.below_dB);
    }
}
