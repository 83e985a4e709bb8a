#include "audio_node/samples/resample.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace tactus::audio;

namespace {

std::vector<float> sine(double frequency_Hz, double rate_Hz, double length_s) {
  std::vector<float> x(static_cast<std::size_t>(length_s * rate_Hz));
  for (std::size_t n = 0; n < x.size(); ++n)
    x[n] = static_cast<float>(std::sin(2 * std::numbers::pi * frequency_Hz * static_cast<double>(n) / rate_Hz));
  return x;
}

}  // namespace

TEST_CASE("A tone is the same tone at another rate") {
  for (const double from : {22050.0, 44100.0, 96000.0})
    for (const double f : {100.0, 1000.0, 7000.0}) {
      CAPTURE(from, f);
      const auto x = resample(sine(f, from, 0.2), from, 48000), truth = sine(f, 48000, 0.2);
      REQUIRE(x.size() == Approx(truth.size()).margin(2));
      // Away from the ends, where the kernel extends beyond the recording; side lobes of -92 dB on both sides of
      // each image, and the -108 dB of the table.
      for (std::size_t n = 1000; n < 8600; ++n) REQUIRE(x[n] == Approx(truth[n]).margin(2e-4));
    }
}

TEST_CASE("Frequencies above the bandwidth of the slower rate are removed without aliasing") {
  const auto x = resample(sine(20000, 96000, 0.2), 96000, 16000);
  float most = 0;
  for (std::size_t n = 300; n + 300 < x.size(); ++n) most = std::max(most, std::abs(x[n]));
  CHECK(most < 1e-3f);  // -60 dB; without the filter it is 1 at 4 kHz
}

TEST_CASE("At its own rate a recording is unchanged") {
  const auto x = sine(440, 48000, 0.1);
  CHECK(resample(x, 48000, 48000) == x);
  CHECK(resample({}, 44100, 48000).empty());
}
