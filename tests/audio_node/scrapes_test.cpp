#include "audio_node/scrapes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "audio_node/pan.h"
#include "tests/audio_node/waves.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

constexpr double kRate_Hz = 48000;
const Place kThere{{0.6f, 0.8f, 0}, 1};  // ahead and to the left

// A second of a contact that slides along u at a speed, told every millisecond with places that jitter.
std::vector<float> heard(const Relief& relief, double speed_m_s, float level, double told_ms = 1000) {
  Scrapes scrapes(kRate_Hz);
  std::vector<float> stereo(2 * 48000);
  for (int ms = 0; ms < 1000; ++ms) {
    if (ms < told_ms) {
      Scrape s;
      s.id = 3, s.at = at_ms(ms), s.relief = &relief;
      const double x = speed_m_s * (ms + (ms % 3 == 0 ? 1 : 0)) * 1e-3;  // now and then a tick ahead
      s.u = x / kWave_m, s.u_per_s = speed_m_s / kWave_m, s.along_u = 1;
      s.travelled_m = x, s.speed_m_s = speed_m_s, s.level = level, s.place = kThere;
      scrapes.take(s);
    }
    scrapes.render(&stereo[static_cast<std::size_t>(96 * ms)], 48, at_ms(ms));
  }
  return stereo;
}

// Amplitude at a frequency of the left channel from 0.2 s to 0.8 s.
double amplitude(const std::vector<float>& stereo, double frequency_Hz) {
  std::complex<double> sum = 0;
  const int from = 9600, n = 28800;
  for (int i = 0; i < n; ++i)
    sum += static_cast<double>(stereo[static_cast<std::size_t>(2 * (from + i))]) *
           std::polar(1.0, -2 * M_PI * frequency_Hz * i / kRate_Hz);
  return 2 * std::abs(sum) / n;
}

}  // namespace

TEST_CASE("What scrapes sounds as the slope of the relief under it, at the speed with which it slides") {
  const Relief relief = make_relief(waves(), rough());
  const double speed = GENERATE(0.05, 0.2, 0.5), slope = M_PI * kHigh_m / kWave_m;
  const auto sound = heard(relief, speed, 0.1f);
  const double tone_Hz = speed / kWave_m;
  const StereoGain gain = pan(kThere);
  // Central differences and linear interpolation over 32 pixels a wave lose 1 %, the jitter some more.
  CHECK(amplitude(sound, tone_Hz) == Approx(0.1 * slope * gain.left).epsilon(0.05));
  CHECK(amplitude(sound, 1.4 * tone_Hz) < 0.05 * 0.1 * slope);
  CHECK(sound[30001] == Approx(sound[30000] * gain.right / gain.left));  // its direction
}

TEST_CASE("A scrape that is told of no more fades, and ends") {
  const Relief relief = make_relief(waves(), rough());
  const auto sound = heard(relief, 0.1, 0.1f, 500);
  double before = 0, after = 0, step = 0;
  for (int i = 20000; i < 24000; ++i) before = std::max(before, std::abs(static_cast<double>(sound[2 * i])));
  for (int i = 28800; i < 48000; ++i) after = std::max(after, std::abs(static_cast<double>(sound[2 * i])));
  for (int i = 1; i < 48000; ++i)
    step = std::max(step, std::abs(static_cast<double>(sound[2 * i] - sound[2 * i - 2])));
  CHECK(before > 0.02);
  CHECK(after < 1e-6);
  CHECK(step < 0.01);  // no click: 50 Hz of 0.03 and a roughness of a tenth of it
}

TEST_CASE("Roughness is the same in every run, and of unit mean square") {
  double square = 0, mean = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double r = roughness(i * 1.3e-5);
    square += r * r / 100'000, mean += r / 100'000;
    REQUIRE(std::abs(r) <= 2.2);
  }
  CHECK(square == Approx(1).epsilon(0.05));
  CHECK(std::abs(mean) < 0.05);
  CHECK(roughness(0.123) == roughness(0.123));
}
