#include "audio_node/excitation/peak.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/audio_node/support/bench.h"

using namespace tactus::audio;
using namespace tactus::audio::test;
using std::numbers::pi;

TEST_CASE("The computed peak of a strike equals that of its sound") {
  SECTION("one mode from rest: the impulse, less its decay until the first swing") {
    // 1 kHz, with a pulse that is short compared with the period: v(t) = J g e^(-d t) (cos w t - d/w sin w t),
    // largest in the first sample.
    const Strike s = strike_of(1, 7, 1000, 20, 0, 0.1f);
    const double t = 0.5 / kRate, truth = 0.1 * std::exp(-20 * t) * std::cos(2 * pi * 1000 * t);
    CHECK(peak_Pa(s, kRate) == Approx(truth).epsilon(0.01));
  }
  SECTION("two bodies with the same mode: both together") {
    Strike s = strike_of(1, 7, 1000, 20, 0, 0.1f);
    const double alone = peak_Pa(s, kRate);
    s.sides[1] = s.sides[0];
    CHECK(peak_Pa(s, kRate) == Approx(2 * alone));
    s.sides[1].gains[0] *= -1;  // opposite sign
    CHECK(peak_Pa(s, kRate) == Approx(0).margin(1e-6));
  }
  SECTION("a click: the largest change of its pulse") {
    Strike s;
    s.pulse = one_hump(48);
    s.sides[0].click = 2;
    float most = 0;
    for (int i = 0; i <= 48; ++i)
      most = std::max(most, std::abs(weight_at(s.pulse, i) - weight_at(s.pulse, i - 1)));
    CHECK(peak_Pa(s, kRate) == Approx(2 * most));
  }
  SECTION("a mode slower than the pulse: the peak after the pulse") {
    // 40 Hz, a quarter period 6 ms: v = J g / n times the sum of the pulse so far; largest when it ends.
    Strike s = strike_of(1, 7, 40, 1, 0, 1.f);
    s.pulse = one_hump(96);  // 2 ms
    CHECK(peak_Pa(s, kRate) == Approx(std::cos(2 * pi * 40 * 0.001)).epsilon(0.03));
  }
}

TEST_CASE("A strike of zero strength has the peak 0") {
  Strike s = strike_of(1, 7, 1000, 20, 0, 0.f);
  CHECK(peak_Pa(s, kRate) == 0);
  CHECK(peak_Pa(Strike{}, kRate) == 0);
}
